#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate cameras`.
struct CamerasOptions {
  std::string json;
};

void add_cameras_options(CLI::App& command, CamerasOptions& options);

/// `palpate cameras`. @throws Error.
void cameras(const CamerasOptions& options);

}  // namespace palpate::app
