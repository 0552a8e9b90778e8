// Replaces the ROS bridge in builds without DDS.
#include "palpate/base/error.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/ros/survey.hpp"

namespace palpate {
namespace {

constexpr const char* kNoDds =
    "this build of palpate has no ROS 2; install Cyclone DDS (cyclonedds-dev) and build again";

}  // namespace

struct RosBridge::Inside {};

RosBridge::RosBridge(const std::vector<Hand>& /*hands*/, const Scene& /*scene*/,
                     std::function<std::vector<StreamState>()> /*streams*/,
                     const RosBridgeOptions& /*options*/) {
  throw Error(kNoDds);
}

RosBridge::~RosBridge() = default;

std::vector<RosTopic> survey_ros(double /*seconds*/) {
  throw Error(kNoDds);
}

std::string RosBridge::problem() const {
  return {};
}

std::optional<RosBridge::RobotState> RosBridge::robot() const {
  return std::nullopt;
}

}  // namespace palpate
