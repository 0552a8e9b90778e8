// Replaces the ROS device driver in builds without DDS.
#include "device/drivers.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

constexpr const char* kNoDds =
    "this build of palpate has no ROS 2; install Cyclone DDS (cyclonedds-dev) and build again";

}  // namespace

DriverInfo list_ros() {
  return {.name = "ros",
          .description = "devices that a node of ROS 2 owns: ros:PRESET",
          .available = false,
          .missing = kNoDds,
          .devices = {}};
}

std::unique_ptr<DeviceDriver> open_ros(const DeviceName& name, const Clock& /*clock*/) {
  throw Error("device ros:" + name.device + ": " + kNoDds);
}

}  // namespace palpate::device
