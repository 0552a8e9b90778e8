#include "events/draft.hpp"

#include <cmath>
#include <numbers>

#include "drawn_cameras.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAway = 50;      // m
constexpr double kAtOnce = 1e-6;  // s

Eigen::Isometry3d with_z(const Vector3d& center, const Vector3d& z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), z).toRotationMatrix();
  pose.translation() = center;
  return pose;
}

}  // namespace

Draft::Draft(std::uint64_t seed) : random_(seed) {
  const double height = between(30, 60) * kDegree;
  const double turn = between(-20, 20) * kDegree;
  const double far = between(0.6, 0.9);
  const Vector3d eye = far * Vector3d(-std::cos(height) * std::cos(turn),
                                      -std::cos(height) * std::sin(turn), std::sin(height));
  look_from(eye);
  event.camera.noise.silhouettes = true;
  event.camera.noise.seed = random_.bits();
  event.scene.solids.push_back({});
  event.scene.solids.push_back({});
  event.scene.solids[1].solid.T_world_solid =
      with_z(Vector3d(between(0.35, 0.5), 0, 0), -Vector3d::UnitX());
  place = Vector3d(between(-0.08, 0.08), between(-0.1, 0.1), 0);
}

void Draft::look_from(const Vector3d& eye) {
  event.camera.T_world_camera = bench::looking(eye, Vector3d::Zero(), Vector3d::UnitZ());
}

Vector3d Draft::level_direction() {
  const double turn = between(0, 2 * std::numbers::pi);
  return {std::cos(turn), std::sin(turn), 0};
}

Vector3d Draft::to_camera(const Vector3d& x) const {
  return (event.camera.T_world_camera.translation() - x).normalized();
}

SimulatedSolid& Draft::block(const Vector3d& center, const Vector3d& out, const Vector3d& half) {
  event.scene.solids.push_back({{SolidKind::block, with_z(center, out), half}, {}});
  return event.scene.solids.back();
}

SimulatedSolid& Draft::cylinder(const Vector3d& center, const Vector3d& axis, double radius,
                                double length) {
  event.scene.solids.push_back(
      {{SolidKind::cylinder, with_z(center, axis), {radius, radius, length / 2}}, {}});
  return event.scene.solids.back();
}

void Draft::goes(SimulatedSolid& solid, double time) {
  solid.motion.velocity = kAway / kAtOnce * Vector3d::UnitX();
  solid.motion.begin = time;
  solid.motion.end = time + kAtOnce;
}

void Draft::comes(SimulatedSolid& solid, double time) {
  goes(solid, time);
  solid.solid.T_world_solid.pretranslate(-kAway * Vector3d::UnitX());
}

void Draft::hold(double seconds) {
  event.hip.insert(event.hip.end(), static_cast<std::size_t>(std::lround(seconds / kTick)),
                   Vector3d(event.hip.back()));
}

void Draft::press(const Vector3d& at, const Vector3d& out, double depth) {
  start(at + 0.01 * out);
  hold(0.6);
  go(at - depth * out, 0.05);
  hold(1);
  event.depth = depth;
  happens();
}

void Draft::go(const Vector3d& goal, double speed) {
  const Vector3d from = event.hip.back();
  const auto ticks = std::lround((goal - from).norm() / (speed * kTick));
  for (long i = 1; i <= ticks; ++i) {
    event.hip.emplace_back(from +
                           static_cast<double>(i) / static_cast<double>(ticks) * (goal - from));
  }
}

}  // namespace palpate::events
