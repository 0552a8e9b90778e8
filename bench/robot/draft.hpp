#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "base/numbers.hpp"
#include "drawn_cameras.hpp"
#include "robot/trial.hpp"

namespace palpate::robot {

inline const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// A floor z = 0 that a camera looks at from 0.5 to 0.9 m, and a hand over it.
class Draft {
 public:
  explicit Draft(std::uint64_t seed) : random_(seed) {
    trial.scene.solids.emplace_back();
    camera();
  }

  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  double one_of(std::initializer_list<double> values) {
    return *(values.begin() + random_.bits() % values.size());
  }
  Eigen::Vector3d level() {
    const double turn = between(0, 2 * std::numbers::pi);
    return {std::cos(turn), std::sin(turn), 0};
  }

  Watcher& camera() {
    Watcher watcher;
    const double tilt = between(0, 55) * kDegree;
    const Eigen::Vector3d eye = std::sin(tilt) * level() + std::cos(tilt) * kUp;
    watcher.options.T_world_camera =
        bench::looking(between(0.5, 0.9) * eye, Eigen::Vector3d::Zero(), {0.1, 1, 0});
    if (random_.uniform() < 0.5)
      watcher.options.camera = {320, 240, {262.5, 262.5, 159.5, 119.5}, {}};
    watcher.options.camera.distortion.k1 = one_of({0, 0, -0.15, 0.15});
    if (random_.uniform() < 0.2) {
      watcher.options.motion.swing = between(0.005, 0.03) * level();
      watcher.options.motion.frequency = between(0.2, 1);
    }
    watcher.options.rate = one_of({5, 10, 15, 30, 30, 60});
    watcher.options.jitter = one_of({0, 0.1 / watcher.options.rate});
    watcher.options.dropped = one_of({0, 0, 0.1});
    watcher.options.noise.kind = static_cast<NoiseKind>(1 + random_.bits() % 3);
    watcher.options.noise.silhouettes = true;
    watcher.options.noise.seed = random_.bits();
    watcher.delay = one_of({0, 0.02, 0.05, 0.15});
    trial.cameras.push_back(watcher);
    return trial.cameras.back();
  }

  SimulatedSolid& floor() { return trial.scene.solids.front(); }
  SimulatedSolid& add(SolidKind kind, const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
    trial.scene.solids.push_back(
        {{kind, Eigen::Isometry3d(Eigen::Translation3d(center)), size}, {}});
    return trial.scene.solids.back();
  }
  static void moves(SimulatedSolid& solid, const Eigen::Vector3d& velocity, double begin,
                    double lasts) {
    solid.motion.velocity = velocity;
    solid.motion.begin = begin;
    solid.motion.end = begin + lasts;
  }
  void floor_rises(double speed, double way, double begin = kHappens) {
    moves(floor(), speed * kUp, begin, way / speed);
  }
  // Is there from then on, and far away before.
  static void comes(SimulatedSolid& solid, double time) {
    constexpr double kAway = 50;  // m
    moves(solid, kAway / 1e-6 * Eigen::Vector3d::UnitX(), time, 1e-6);
    solid.solid.T_world_solid.pretranslate(-kAway * Eigen::Vector3d::UnitX());
  }

  void go(const Eigen::Vector3d& goal, double speed) {
    const Eigen::Vector3d from = trial.hip.back();
    const auto ticks = std::max(std::lround((goal - from).norm() / (speed * kTick)), 1L);
    for (long i = 1; i <= ticks; ++i) {
      trial.hip.emplace_back(from +
                             static_cast<double>(i) / static_cast<double>(ticks) * (goal - from));
    }
  }
  void hold_until(double time) {
    const auto ticks = static_cast<std::size_t>(std::lround(time / kTick));
    if (ticks > trial.hip.size()) trial.hip.resize(ticks, Eigen::Vector3d(trial.hip.back()));
  }

  // The hand hovers or presses when things happen, and goes on; later it is lifted and comes again.
  void hand(const Eigen::Vector3d& over = Eigen::Vector3d::Zero()) {
    const Eigen::Vector3d up = over + 0.08 * kUp;
    trial.hip = {up};
    hold_until(1);
    const double height = random_.uniform() < 0.3 ? between(0.02, 0.06) : -between(0, 0.1);
    go(over + height * kUp, between(0.1, 0.3));
    hold_until(kHappens);
    if (random_.uniform() < 0.5) go(trial.hip.back() + 0.05 * level(), between(0.02, 0.1));
    hold_until(between(4, 5));
    go(over + 0.35 * kUp, between(0.2, 0.5));
    hold_until(static_cast<double>(trial.hip.size()) * kTick + 0.7);
    go(over + 0.05 * level() + height * kUp, between(0.1, 0.3));
    hold_until(kEnd);
    trial.hip.resize(static_cast<std::size_t>(std::lround(kEnd / kTick)));
  }

  // Nothing is measured in a disc around where the hand is.
  void hole(Watcher& watcher, double from, double lasts) {
    const double radius = between(0.02, 0.06);
    const Eigen::Vector3d at = watcher.options.T_world_camera.inverse() *
                               Eigen::Vector3d(trial.hip[2500].x(), trial.hip[2500].y(), 0);
    watcher.fault = [=](DepthFrame& frame) {
      if (frame.stamp < from || frame.stamp > from + lasts) return true;
      bench::punch_hole(at, radius, frame);
      return true;
    };
  }

  Trial trial;

 private:
  Random random_;
};

}  // namespace palpate::robot
