// A robot that follows /target_pose with a lag of 50 ms and stops when it is told nothing for 100
// ms: robot_node SECONDS [X Y Z]. Prints, for a ball of 60 mm around the origin, how deep targets
// and the robot were in it at worst (mm), all of a box of X x Y x Z mm where it holds one, and how
// far the robot went after it was told nothing any more.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"

namespace {

constexpr double kRadius = 0.06;  // m

// How deep a box is in the ball, m; its edges are twice `half` long.
double depth_of(const Eigen::Isometry3d& box, const Eigen::Vector3d& half) {
  const Eigen::Vector3d ball = box.inverse().translation();
  return kRadius - (ball - ball.cwiseMax(-half).cwiseMin(half)).norm();
}

}  // namespace

int main(int count, char** arguments) {
  using namespace palpate;
  if (count != 2 && count != 5) return 2;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  for (int k = 2; k < count; ++k) half[k - 2] = 0.5e-3 * std::stod(arguments[k]);
  constexpr double kLag = 0.05;      // s
  constexpr double kWatchdog = 0.1;  // s
  constexpr double kPeriod = 1e-3;   // s
  const dds::Participant participant(dds::environment_options());
  dds::Reader<message::PoseStamped> targets(participant, "/target_pose", {.reliable = true});
  SteadyClock clock;
  message::PoseStamped told;
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d robot = target;
  double heard = 0;
  std::uint64_t received = 0;
  double target_depth = -1;
  double robot_depth = -1;
  double after = 0;
  const double start = clock.now();
  for (double now = start; now < start + std::stod(arguments[1]);
       clock.wait_until(now + kPeriod), now = clock.now()) {
    while (targets.take(told)) {
      target = *message::isometry(told.pose);
      if (received++ == 0) robot = target;
      heard = now;
      after = 0;
      target_depth = std::max(target_depth, depth_of(target, half));
    }
    const bool alive = received > 0 && now - heard < kWatchdog;
    if (!alive) continue;
    const Eigen::Vector3d step =
        (1 - std::exp(-kPeriod / kLag)) * (target.translation() - robot.translation());
    if (now - heard > 0.02) after += step.norm();
    robot.translation() += step;
    robot.linear() = target.linear();
    robot_depth = std::max(robot_depth, depth_of(robot, half));
  }
  fmt::print(
      "{} targets; target at most {:.3f} mm deep, robot {:.3f} mm; {:.2f} mm after the last "
      "target\n",
      received, 1e3 * target_depth, 1e3 * robot_depth, 1e3 * after);
}
