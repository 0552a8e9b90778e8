#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include "palpate/device/simulated.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "support/snapshots.hpp"

namespace palpate::test {

/// A sheet at z = 0, R = 10 mm, and nothing else.
inline Source& add_sheet(Scene& scene) {
  Source& source = scene.add("sheet");
  source.publish(still(plane(0)));
  return source;
}

/// The guard's links fault, watchdog, slew and clamp alone: without the others a force passes bit
/// for bit.
inline ServoOptions first_links() {
  ServoOptions options;
  options.guard.damping = 0;
  options.guard.soft_start = 0;
  options.guard.passivity.on = false;
  options.guard.stiffness_share = std::numeric_limits<double>::infinity();
  return options;
}

/// The same at a metaball, which pushes a hand that starts in it out.
inline ServoOptions pushed_out() {
  ServoOptions options = first_links();
  options.field.kind = FieldOptions::Kind::metaball;
  return options;
}

/// Down through the sheet to 4 mm under it, across, and up again, in a second of milliseconds.
inline Trajectory visit() {
  Trajectory rows;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 1e-3 * i;
    const double depth = 14e-3 * std::min(1.0, 2.5 * std::sin(M_PI * t));
    rows.push_back({t, {0.02 * (t - 0.5), 0.3e-3, 10e-3 - depth}});
  }
  return rows;
}

/// A device that renders nothing unless it is told to and has no time of its own, wherever it is
/// told to be.
class FreeDevice final : public Device {
 public:
  explicit FreeDevice(const Eigen::Vector3d& position = Eigen::Vector3d::Zero()) {
    info_.name = "free";
    state_.position = position;
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override {
    if (last_step_ >= 0 && reads_ > last_step_) state_.status = DeviceState::Status::finished;
    ++reads_;
    return state_;
  }
  void write(const Eigen::Vector3d& force) noexcept override { wrench_ = {.force = force}; }
  void write_wrench(const Wrench& wrench) noexcept override { wrench_ = wrench; }
  [[nodiscard]] std::string reason() const override { return "told to"; }

  DeviceInfo& info() noexcept { return info_; }
  DeviceState& state() noexcept { return state_; }
  void finish_after(int reads) noexcept { last_step_ = reads - 1; }
  [[nodiscard]] const Eigen::Vector3d& force() const noexcept { return wrench_.force; }
  [[nodiscard]] const Wrench& wrench() const noexcept { return wrench_; }

 private:
  DeviceInfo info_;
  DeviceState state_;
  Wrench wrench_;
  int reads_ = 0;
  int last_step_ = -1;
};

}  // namespace palpate::test
