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

/// The command line of `palpate cameras`.
struct CamerasOptions {
  std::string json;
};

void add_cameras_options(CLI::App& command, CamerasOptions& options);

/// `palpate cameras`. @throws Error.
void cameras(const CamerasOptions& options);

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
