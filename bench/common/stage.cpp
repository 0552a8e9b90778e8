// Draws solids, their motions and the path of a hand.
#include "common/stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::bench {
namespace {

using Eigen::Vector3d;

constexpr double kAway = 50;      // m; judgement: beyond the range of all cameras
constexpr double kAtOnce = 1e-6;  // s; judgement: far below a tick

}  // namespace

Eigen::Isometry3d looking(const Vector3d& from, const Vector3d& at, const Vector3d& up) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Vector3d z = (at - from).normalized();
  const Vector3d x = z.cross(up).normalized();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = from;
  return pose;
}

void punch_hole(const Vector3d& seen, double radius, DepthFrame& frame) {
  const Pinhole& p = frame.camera.pinhole;
  const double u = p.cx + p.fx * seen.x() / seen.z();
  const double v = p.cy + p.fy * seen.y() / seen.z();
  const double pixels = radius * p.fx / seen.z();
  for (int row = 0; row < frame.camera.height; ++row) {
    for (int column = 0; column < frame.camera.width; ++column) {
      if (std::hypot(column - u, row - v) > pixels) continue;
      frame.depth[static_cast<std::size_t>(row) * frame.camera.width + column] = 0;
    }
  }
}

Vector3d Stage::level_direction() {
  const double turn = between(0, 2 * std::numbers::pi);
  return {std::cos(turn), std::sin(turn), 0};
}

SimulatedSolid& Stage::add(SolidKind kind, const Vector3d& center, const Vector3d& half,
                           const Vector3d& out) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(kUp, out).toRotationMatrix();
  pose.translation() = center;
  scene.solids.push_back({{kind, pose, half}, {}});
  return scene.solids.back();
}

void Stage::moves(SimulatedSolid& solid, const Vector3d& velocity, double begin, double lasts) {
  solid.motion.velocity = velocity;
  solid.motion.begin = begin;
  solid.motion.end = begin + lasts;
}

void Stage::goes(SimulatedSolid& solid, double time) {
  moves(solid, kAway / kAtOnce * Vector3d::UnitX(), time, kAtOnce);
}

void Stage::comes(SimulatedSolid& solid, double time) {
  goes(solid, time);
  solid.solid.T_world_solid.pretranslate(-kAway * Vector3d::UnitX());
}

void Stage::hold(double seconds) {
  hip.insert(hip.end(), static_cast<std::size_t>(std::lround(seconds / kTick)),
             Vector3d(hip.back()));
}

void Stage::go(const Vector3d& goal, double speed) {
  const Vector3d from = hip.back();
  const auto ticks = std::max(std::lround((goal - from).norm() / (speed * kTick)), 1L);
  for (long i = 1; i <= ticks; ++i) {
    hip.emplace_back(from + static_cast<double>(i) / static_cast<double>(ticks) * (goal - from));
  }
}

}  // namespace palpate::bench
