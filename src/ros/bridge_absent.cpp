#include "palpate/base/error.hpp"
#include "palpate/ros/bridge.hpp"

namespace palpate {

struct RosBridge::Inside {};

RosBridge::RosBridge(std::vector<Hand> /*hands*/, const Scene& /*scene*/,
                     std::function<std::vector<StreamState>()> /*streams*/,
                     const RosBridgeOptions& /*options*/) {
  throw Error(
      "this build of palpate has no ROS 2; install Cyclone DDS (cyclonedds-dev) and build again");
}

RosBridge::~RosBridge() = default;

std::string RosBridge::problem() const {
  return {};
}

}  // namespace palpate
