// The commands devices, cameras and ros.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate devices` and of `palpate cameras`.
struct ListOptions {
  std::string json;
};

void add_devices_options(CLI::App& command, ListOptions& options);

/// `palpate devices`. @throws Error.
void devices(const ListOptions& options);

void add_cameras_options(CLI::App& command, ListOptions& options);

/// `palpate cameras`. @throws Error.
void cameras(const ListOptions& options);

/// The command line of `palpate ros`.
struct RosOptions {
  std::string json;
  double seconds = 3;
  std::string range;
};

void add_ros_options(CLI::App& command, RosOptions& options);

/// `palpate ros`. @throws Error.
void ros(const RosOptions& options);

}  // namespace palpate::app
