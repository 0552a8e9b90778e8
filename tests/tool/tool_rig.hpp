#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "palpate/tool/tool_proxy.hpp"
#include "support/rates.hpp"
#include "tool/motion.hpp"

namespace palpate::test {

inline constexpr double kSupport = 0.01;  ///< R of analytic fields, m

inline constexpr double kStiffness = 500;                                     ///< N/m
inline constexpr double kGyration = 0.03;                                     ///< m
inline constexpr double kTurnStiffness = kStiffness * kGyration * kGyration;  ///< N m/rad
inline constexpr ToolOptions kOptions{.stiffness = kStiffness, .gyration = kGyration};

/// A tool with its handle at a position, turned by a rotation vector (rad).
inline Pose pose_at(const Eigen::Vector3d& position,
                    const Eigen::Vector3d& turn = Eigen::Vector3d::Zero(), double opening = 0) {
  return {position, turned(Eigen::Quaterniond::Identity(), turn), opening};
}

inline ToolProxy proxy_of(Tool tool, const ToolOptions& options = {}) {
  return ToolProxy(std::make_shared<const Tool>(std::move(tool)), options);
}

/// Moves the hand from one pose to another in `steps` steps, and lets it rest there for `rest`
/// more.
inline ToolContact press(ToolProxy& proxy, const Field& field, const Pose& from, const Pose& to,
                         int steps = 100, int rest = 600) {
  proxy.reset(from);
  const Eigen::Vector3d turn = turn_between(from.orientation, to.orientation);
  ToolContact contact;
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    Pose hand = from;
    hand.position += share * (to.position - from.position);
    hand.orientation = turned(from.orientation, share * turn);
    hand.opening += share * (to.opening - from.opening);
    contact = proxy.step(field, hand, kTick);
  }
  for (int i = 0; i < rest; ++i) contact = proxy.step(field, to, kTick);
  return contact;
}

/// A box, a stylus, a cylinder and a gripper.
inline std::vector<Tool> four_tools() {
  std::vector<Tool> tools;
  tools.push_back(Tool::box({0.02, 0.03, 0.01}, 0.005));
  tools.push_back(Tool::capsule(0.05, 0.004, 0.005));
  tools.push_back(Tool::cylinder(0.03, 0.006, 0.003));
  tools.push_back(Tool::gripper({0.006, 0.012, 0.03}, 0.004));
  return tools;
}

/// The deepest that a sample is in the surface, m; below 0: none is.
inline double depth_of(const ToolProxy& proxy, const Field& field) {
  double depth = -1;
  for (const Tool::Point& each : proxy.tool().samples()) {
    const Eigen::Vector3d x = proxy.tool().in_world(each.position, each.side, proxy.pose());
    depth = std::max(depth, each.radius - field.sample(x).value);
  }
  return depth;
}

/// How far x is outside of the nearest sample, m.
inline double nearest(const Tool& tool, const Eigen::Vector3d& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const Tool::Point& each : tool.samples()) {
    least = std::min(least, (each.position - x).norm() - each.radius);
  }
  return least;
}

}  // namespace palpate::test
