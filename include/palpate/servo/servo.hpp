#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "palpate/base/latest.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/workspace.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/histogram.hpp"
#include "palpate/servo/servo_state.hpp"

namespace palpate {

struct ServoOptions {
  FieldOptions field = {};
  ProxyOptions proxy = {};
  GuardOptions guard = {};  ///< at the hand; fitted to the device by guard_for()
  Workspace workspace = {};
  /// While this button of the device is down, 0 to 31, the hand moves freely (Clutch).
  std::optional<int> clutch_button = {};
  StepQueue* steps = nullptr;  ///< every step is put into it; outlives the servo
};

/// What may change while a servo runs.
struct Feel {
  double stiffness = 500;  ///< K, N/m
  Friction friction = {};
  Texture texture = {};
};

/// One hand in a scene: SceneField, Proxy and Guard between a device's place and its force.
///
/// Owns no thread: a device's callback calls tick(), or a ServoThread does, or whoever owns the
/// loop makes a step of its parts. One thread steps; all that is marked so may be called by others
/// meanwhile. Device and scene outlive it. While the device is silent the hand feels nothing: the
/// force fades and comes back at the guard's rate, and the contact begins with the first hand
/// heard.
///
/// While the clutch is held the tool rests at the proxy, and goes where a surface takes that. So
/// nothing is stretched when it is let go: no force comes until the hand pushes, and none that it
/// did not pay for. What the force is worth until it is gone counts in the guard's ledger, which is
/// told of the hand's own way.
class Servo {
 public:
  /// Of a device's continuous maximum: what it is asked to hold (docs/method.md 8.6).
  static constexpr double kForceShare = 0.8;

  /// @throws Error when an option is out of its range or the scene has too many readers.
  Servo(Device& device, Scene& scene, const ServoOptions& options = {});
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  /// One step: reads the device, computes, writes the force, shows the state. `now`: s, on the
  /// clock that snapshots are stamped on; it never goes back. noexcept, allocation-free, lock-free;
  /// what the device does in read() and write() is the device's.
  const ServoState& tick(double now) noexcept;

  /// A step at the device's own time: for simulated time.
  const ServoState& tick() noexcept;

  /// The computing part of a step alone: the force for the device is in state().force, world frame.
  /// Shows nothing yet. Real-time (docs/architecture.md, contract 1).
  const ServoState& step(const DeviceState& device, double now) noexcept;

  /// Shows the last step to those who watch, with what was measured of it. Real-time.
  void show(const StepTiming& timing = {}) noexcept;

  /// `state.force` in the device's frame.
  [[nodiscard]] Eigen::Vector3d device_force() const noexcept {
    return options_.workspace.force_to_device(state_.force);
  }

  [[nodiscard]] Device& device() const noexcept { return device_; }
  [[nodiscard]] const ServoOptions& options() const noexcept { return options_; }

  /// The stiffest surface that this device can hold in this workspace, N/m in the world; what is
  /// asked for beyond it is felt as this (docs/method.md 8.1). Infinite where it renders none.
  [[nodiscard]] double stiffness_limit() const noexcept { return stiffness_limit_; }

  /// The newest state. Any thread.
  [[nodiscard]] ServoState state() const noexcept { return shown_.get(); }
  /// How late steps began and what they took to compute, where it was measured. Any thread.
  [[nodiscard]] Durations lateness() const noexcept { return lateness_.look(); }
  [[nodiscard]] Durations computing() const noexcept { return computing_.look(); }

  /// What the guard let through in every step of late, N, world frame. Any thread.
  [[nodiscard]] const RecentForces& recent_forces() const noexcept { return recent_forces_; }

  /// Lets the hand feel nothing: the force goes to zero at the guard's rate, and back. Any thread.
  void pause(bool paused) noexcept { paused_.store(paused); }
  /// Forgets faults, the contact and what the clutch moved in the next step; tool and proxy are put
  /// to the hand. Any thread.
  void reset() noexcept { reset_.store(true); }

  /// Changes what is felt from the next step on. In contact, stiffness changes as EnergyTank
  /// allows: the hand is given no energy. Any thread; not real-time.
  /// @throws Error when a value is out of its range.
  void set_feel(const Feel& feel);

  /// Makes another surface of the same points from the next step on; the guard sees to it that the
  /// force goes there softly. Any thread; not real-time.
  /// @throws Error when an option is out of its range.
  void set_field(const FieldOptions& field);
  /// The surface that is felt, from the next step on at the latest. Any thread.
  [[nodiscard]] FieldOptions field() const noexcept { return wanted_field_.get(); }

 private:
  void take_wishes() noexcept;
  void place_tool(const DeviceState& device) noexcept;
  [[nodiscard]] bool is_clutched(std::uint32_t buttons) const noexcept;
  [[nodiscard]] Eigen::Vector3d guarded() noexcept;

  Device& device_;
  ServoOptions options_;
  double stiffness_limit_;
  bool softened_;  // a stiffer surface is asked for
  SceneField field_;
  Proxy proxy_;
  Guard guard_;
  Clutch clutch_;
  Eigen::Vector3d hand_ = Eigen::Vector3d::Zero();  // where it is without the clutch, m, world
  ServoState state_;  // of the stepping thread; the others see what was shown
  bool started_ = false;
  bool heard_ = false;  // the device has known where the hand is
  std::uint64_t feel_seen_ = 0;
  std::uint64_t field_seen_ = 0;

  Latest<ServoState> shown_;
  RecentForces recent_forces_;
  Histogram lateness_;
  Histogram computing_;
  std::mutex wish_mutex_;  // between those who change what is felt; the step never takes it
  Latest<Feel> feel_;
  Latest<FieldOptions> wanted_field_;
  std::atomic<bool> paused_{false};
  std::atomic<bool> reset_{false};
};

/// `options` at the hand of a device: maximum_force is lowered to Servo::kForceShare of what it can
/// hold, silence raised to 2.5 periods of slow ones, mass and delay are what it tells.
[[nodiscard]] GuardOptions guard_for(const DeviceInfo& device, GuardOptions options);

}  // namespace palpate
