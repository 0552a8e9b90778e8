// Draws what all trials have: the floor, cameras, and a hand that comes twice.
#include <cmath>

#include "robot/trial.hpp"

namespace palpate::robot {

using Eigen::Vector3d;

Trial::Trial(std::uint64_t number) : Stage(number) {
  scene.solids.emplace_back();
  camera();
}

Watcher& Trial::camera() {
  Watcher watcher;
  SimulatedCameraOptions& options = watcher.options;
  const double tilt = between(0, 55) * kDegree;
  const Vector3d eye = std::sin(tilt) * level_direction() + std::cos(tilt) * kUp;
  options.T_world_camera = bench::looking(between(0.5, 0.9) * eye, Vector3d::Zero(), {0.1, 1, 0});
  if (random.uniform() < 0.5) options.camera = {320, 240, {262.5, 262.5, 159.5, 119.5}, {}};
  options.camera.distortion.k1 = one_of({0, 0, -0.15, 0.15});
  if (random.uniform() < 0.2) {
    options.motion.swing = between(0.005, 0.03) * level_direction();
    options.motion.frequency = between(0.2, 1);
  }
  options.rate = one_of({5, 10, 15, 30, 30, 60});
  options.jitter = one_of({0, 0.1 / options.rate});
  options.dropped = one_of({0, 0, 0.1});
  options.noise.kind = static_cast<NoiseKind>(1 + random.bits() % 3);
  options.noise.silhouettes = true;
  options.noise.seed = random.bits();
  watcher.delay = one_of({0, 0.02, 0.05, 0.15});
  cameras.push_back(watcher);
  return cameras.back();
}

void Trial::hold_until(double time) {
  const auto ticks = static_cast<std::size_t>(std::lround(time / kTick));
  if (ticks > hip.size()) hip.resize(ticks, Vector3d(hip.back()));
}

void Trial::hand() {
  hip = {0.08 * kUp};
  hold_until(1);
  const double height = random.uniform() < 0.3 ? between(0.02, 0.06) : -between(0, 0.1);
  go(height * kUp, between(0.1, 0.3));
  hold_until(kHappens);
  if (random.uniform() < 0.5) go(hip.back() + 0.05 * level_direction(), between(0.02, 0.1));
  hold_until(between(4, 5));
  go(0.35 * kUp, between(0.2, 0.5));
  hold_until(now() + 0.7);
  go(0.05 * level_direction() + height * kUp, between(0.1, 0.3));
  hold_until(kEnd);
  hip.resize(static_cast<std::size_t>(std::lround(kEnd / kTick)));
}

void Trial::hole(Watcher& watcher, double from, double lasts) {
  const double radius = between(0.02, 0.06);
  const Vector3d at =
      watcher.options.T_world_camera.inverse() * Vector3d(hand_then().x(), hand_then().y(), 0);
  watcher.fault = [=](DepthFrame& frame) {
    if (frame.stamp >= from && frame.stamp <= from + lasts) bench::punch_hole(at, radius, frame);
    return true;
  };
}

}  // namespace palpate::robot
