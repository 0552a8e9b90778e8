// Reads the trajectory that hands follow.
#include <fmt/format.h>

#include <algorithm>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/run/run.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {
namespace {

constexpr double kLongestRun = 86'400;  // s

constexpr const char* kStraight =
    "straight: its trajectory has no columns qx,qy,qz,qw or roll,pitch,yaw";

void check(const Trajectory& trajectory, const std::string& file, bool simulated) {
  if (trajectory.empty()) return;
  const double duration = trajectory.back().time - trajectory.front().time;
  if (simulated && duration > kLongestRun) {
    throw UsageError(
        fmt::format("--trajectory lasts {:.6g} s; --device simulated plays at most {:.0f} s: are "
                    "its times in seconds?",
                    duration, kLongestRun));
  }
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double far = trajectory[i].position.cwiseAbs().maxCoeff();
    if (far <= Proxy::kLargestCoordinate) continue;
    throw Error(
        fmt::format("row {} of {} is {:.4g} m from the origin; surfaces beyond {:.0e} m cannot be "
                    "resolved: are its positions in metres?",
                    i, file, far, Proxy::kLargestCoordinate));
  }
}

}  // namespace

Trajectory trajectory_of(MotionPlan& motion, const std::vector<DevicePlan>& devices) {
  const bool follows = std::ranges::any_of(devices, &DevicePlan::follows_trajectory);
  if (motion.trajectory.empty() || !follows) return {};
  TrajectoryOptions reading = motion.reading;
  reading.remark = [&](const std::string& words) { motion.held = "as its columns say: " + words; };
  Trajectory trajectory = read_trajectory(motion.trajectory, reading);
  if (!trajectory.front().orientation) motion.held = kStraight;
  if (motion.reading.forces && !trajectory.front().force) {
    throw Error(motion.trajectory + " has no columns fx, fy, fz; --compare needs them");
  }
  const bool simulated = std::ranges::any_of(
      devices, [](const DevicePlan& each) { return each.kind == DeviceKind::simulated; });
  check(trajectory, motion.trajectory, simulated);
  return trajectory;
}

}  // namespace palpate::app
