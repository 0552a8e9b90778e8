// A robot that follows /target_pose with a lag of 50 ms and stops when it is told nothing for 100
// ms: robot_node SECONDS. Prints, for a ball of 60 mm around the origin, how deep targets and the
// robot were in it at worst (mm), and how far the robot went after it was told nothing any more.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"

int main(int count, char** arguments) {
  using namespace palpate;
  if (count != 2) return 2;
  constexpr double kLag = 0.05;      // s
  constexpr double kWatchdog = 0.1;  // s
  constexpr double kPeriod = 1e-3;   // s
  constexpr double kRadius = 0.06;   // m
  const dds::Participant participant(dds::environment_options());
  dds::Reader<message::PoseStamped> targets(participant, "/target_pose", {.reliable = true});
  SteadyClock clock;
  message::PoseStamped told;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d robot = Eigen::Vector3d::Zero();
  double heard = 0;
  std::uint64_t received = 0;
  double target_depth = -1;
  double robot_depth = -1;
  double after = 0;
  const double start = clock.now();
  for (double now = start; now < start + std::stod(arguments[1]);
       clock.wait_until(now + kPeriod), now = clock.now()) {
    while (targets.take(told)) {
      target = message::isometry(told.pose)->translation();
      if (received++ == 0) robot = target;
      heard = now;
      after = 0;
      target_depth = std::max(target_depth, kRadius - target.norm());
    }
    const bool alive = received > 0 && now - heard < kWatchdog;
    if (!alive) continue;
    const Eigen::Vector3d step = (1 - std::exp(-kPeriod / kLag)) * (target - robot);
    if (now - heard > 0.02) after += step.norm();
    robot += step;
    robot_depth = std::max(robot_depth, kRadius - robot.norm());
  }
  fmt::print(
      "{} targets; target at most {:.3f} mm deep, robot {:.3f} mm; {:.2f} mm after the last "
      "target\n",
      received, 1e3 * target_depth, 1e3 * robot_depth, 1e3 * after);
}
