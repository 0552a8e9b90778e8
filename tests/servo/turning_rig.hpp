#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <utility>

#include "servo/servo_rig.hpp"

namespace palpate::test {

/// A hand that does what a function of the time says.
class LedHand final : public TargetSource {
 public:
  explicit LedHand(std::function<Target(double)> way) : way_(std::move(way)) {}
  [[nodiscard]] Target target(double time, const Eigen::Vector3d&) noexcept override {
    return way_(time);
  }

 private:
  std::function<Target(double)> way_;
};

/// Where a hand is, with the tool turned about y, rad.
inline TargetSource::Target held_at(const Eigen::Vector3d& position, double turn = 0) {
  TargetSource::Target target;
  target.position = position;
  target.orientation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY());
  return target;
}

/// A simulated device with a wrist, on which nothing rubs and whose encoders are exact.
inline SimulatedDeviceOptions smooth_device(double maximum_torque) {
  SimulatedDeviceOptions options;
  options.coulomb = 0;
  options.resolution = 0;
  options.wrist.emplace();
  options.wrist->coulomb = 0;
  options.wrist->resolution = 0;
  options.wrist->maximum_torque = maximum_torque;
  return options;
}

/// A tool in a simulated hand on a sheet, in simulated time.
class TurningHand {
 public:
  TurningHand(const SimulatedDeviceOptions& device, ServoOptions options, const char* tool,
              std::function<TargetSource::Target(double)> way)
      : hand_(std::move(way)), device_(device, hand_) {
    add_sheet(scene_);
    options.tool = std::make_shared<const Tool>(Tool::from_text(tool, 4e-3));
    servo_ = std::make_unique<Servo>(device_, scene_, options);
  }

  const ServoState& step() {
    const ServoState& state = servo_->tick();
    if (state.step > 1) by_surface_ += acting_.dot(state.contact.drift) * state.dt;
    acting_ = sent_;
    sent_ = state.force;
    touching_ += state.contact.touching ? 1 : 0;
    return state;
  }
  const ServoState& run(int steps) {
    for (int i = 1; i < steps; ++i) step();
    return step();
  }

  /// Work of forces and torques that were felt, J.
  [[nodiscard]] double given() const { return device_.work(); }
  /// What of that is the work of turns that were not felt: of the surface that the drift moves, J.
  [[nodiscard]] double by_surface() const { return by_surface_; }
  [[nodiscard]] int touching() const { return touching_; }
  [[nodiscard]] Servo& servo() { return *servo_; }

 private:
  Scene scene_;
  LedHand hand_;
  SimulatedDevice device_;
  std::unique_ptr<Servo> servo_;
  Eigen::Vector3d sent_ = Eigen::Vector3d::Zero();    // N, in the last step
  Eigen::Vector3d acting_ = Eigen::Vector3d::Zero();  // a step before, by the device's delay
  double by_surface_ = 0;
  int touching_ = 0;
};

}  // namespace palpate::test
