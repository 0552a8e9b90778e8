#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate devices`.
struct DevicesOptions {
  std::string json;
};

void add_devices_options(CLI::App& command, DevicesOptions& options);

/// `palpate devices`. @throws Error.
void devices(const DevicesOptions& options);

}  // namespace palpate::app
