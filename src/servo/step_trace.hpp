#pragma once

#include <optional>

#include "palpate/servo/servo.hpp"

namespace palpate {

/// All that a servo's step depended on besides the servo's options and the steps before: with it
/// the step can be done again, to the same force, bit for bit.
struct StepInput {
  DeviceState device;
  SceneField::Found found;
  bool reset = false;                           ///< Servo::reset() was called
  std::optional<ContactSettings> contact = {};  ///< where it was changed for this step
  std::optional<FieldOptions> field = {};       ///< the same of the field
  std::optional<Eigen::Vector3d> added = {};    ///< a new Servo::add_force(), N
};

/// A step with what it was made of.
struct StepTrace {
  ServoState state;
  StepInput input;
};

using StepTraces = Ring<StepTrace>;

/// Shows a recorded servo's states on a servo that is not stepped. The servo outlives it.
class ServoTrace {
 public:
  explicit ServoTrace(Servo& servo) : servo_(&servo) {}

  /// The servo's state is this one from now on, but that its steps count what was shown. One
  /// thread.
  void show(const ServoState& state) noexcept;

 private:
  Servo* servo_;
};

}  // namespace palpate
