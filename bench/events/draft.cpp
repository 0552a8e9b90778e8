// Draws what all events have: the table-top, the camera, and a hand that presses.
#include <cmath>
#include <numbers>

#include "events/event.hpp"

namespace palpate::events {

using Eigen::Vector3d;

Event::Event(std::uint64_t number) : Stage(number) {
  const double height = between(30, 60) * kDegree;
  const double turn = between(-20, 20) * kDegree;
  const double far = between(0.6, 0.9);
  look_from(far * Vector3d(-std::cos(height) * std::cos(turn), -std::cos(height) * std::sin(turn),
                           std::sin(height)));
  camera.noise.silhouettes = true;
  camera.noise.seed = random.bits();
  scene.solids.emplace_back();
  add(SolidKind::half_space, Vector3d(between(0.35, 0.5), 0, 0), Vector3d::Zero(),
      -Vector3d::UnitX());
  place = Vector3d(between(-0.08, 0.08), between(-0.1, 0.1), 0);
}

void Event::look_from(const Vector3d& eye) {
  camera.T_world_camera = bench::looking(eye, Vector3d::Zero(), kUp);
}

void Event::look_from(double tilt, double distance) {
  look_from(distance * Vector3d(-std::sin(tilt), 0, std::cos(tilt)));
}

void Event::seen_by(const std::string& family) {
  SimulatedSetup setup;
  setup.camera.noise.seed = camera.noise.seed;
  set_simulated(setup, "noise=" + family);
  camera.noise = setup.camera.noise;
}

Vector3d Event::to_camera(const Vector3d& x) const {
  return (camera.T_world_camera.translation() - x).normalized();
}

void Event::press(const Vector3d& at, const Vector3d& out, double deep) {
  start(at + 0.01 * out);
  hold(0.6);
  go(at - deep * out, 0.05);
  hold(1);
  depth = deep;
  happens();
}

}  // namespace palpate::events
