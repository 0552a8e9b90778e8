#include <fmt/format.h>

#include "palpate/base/error.hpp"
#include "sensor/drivers.hpp"

namespace palpate::sensor {
namespace {

constexpr const char* kNoDds =
    "this build of palpate has no ROS 2. Install Cyclone DDS (cyclonedds-dev) and build again";

}  // namespace

DriverInfo ros_driver() {
  return {.name = "ros",
          .description = "topics of ROS 2: ros:TOPIC[,frame=FRAME]",
          .available = false,
          .missing = kNoDds,
          .devices = {}};
}

std::unique_ptr<DepthCamera> open_ros(const std::string& name, const CameraOptions& /*options*/) {
  throw Error(fmt::format("ros:{}: {}.", name, kNoDds));
}

}  // namespace palpate::sensor
