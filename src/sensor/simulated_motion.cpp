#include "palpate/sensor/simulated_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

// For how long the straight line and the turn have gone on at time t.
double elapsed(const SimulatedMotion& motion, double t) {
  const double from = std::isfinite(motion.begin) ? motion.begin : 0;
  return std::clamp(t, motion.begin, motion.end) - from;
}

double sine_angle(const SimulatedMotion& motion, double t) {
  return 2 * std::numbers::pi * motion.frequency * t + motion.phase;
}

}  // namespace

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const SimulatedMotion& motion, double t) {
  const double time = elapsed(motion, t);
  const double sine = std::sin(sine_angle(motion, t));
  const Eigen::AngleAxisd turn(motion.spin * time + motion.rock * sine, motion.axis);
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = turn.toRotationMatrix() * pose.linear();
  out.translation() = pose.translation() + motion.velocity * time + motion.swing * sine;
  return out;
}

Eigen::Vector3d velocity(const Eigen::Isometry3d& pose, const SimulatedMotion& motion,
                         const Eigen::Vector3d& x, double t) {
  const double on = t >= motion.begin && t <= motion.end ? 1 : 0;
  const double rate = 2 * std::numbers::pi * motion.frequency * std::cos(sine_angle(motion, t));
  const Eigen::Vector3d turning = (on * motion.spin + rate * motion.rock) * motion.axis;
  const Eigen::Vector3d arm = x - moved(pose, motion, t).translation();
  return on * motion.velocity + rate * motion.swing + turning.cross(arm);
}

}  // namespace palpate
