// Puts force, torque and grip into one metric, and passes them through the links of a guard.
#include "servo/wrench_guard.hpp"

#include <algorithm>

#include "geometry/wrench.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// The lightest of its axes bounds a brake: I / g^2 of a turn, kg.
GuardOptions with_turns(GuardOptions options, const DeviceInfo& device, double scale,
                        double gyration) {
  if (device.maximum_torque > 0 && device.inertia > 0) {
    const double of_turns = device.inertia * scale / (gyration * gyration);
    options.passivity.mass = std::min(options.passivity.mass, of_turns);
  }
  return options;
}

}  // namespace

Motion WrenchAxes::shortened(const Motion& force) const noexcept {
  const Wrench held = palpate::shortened({force.head<3>(), force.segment<3>(3), force[6]},
                                         maximum_force, maximum_torque, maximum_grip);
  return (Motion() << held.force, held.torque, held.grip).finished();
}

WrenchGuard::WrenchGuard(const GuardOptions& options, const DeviceInfo& device, double scale,
                         double gyration)
    : renders_torque_(device.maximum_torque > 0),
      renders_grip_(device.maximum_grip > 0),
      gyration_(gyration),
      chain_(with_turns(options, device, scale, gyration),
             {options.maximum_force, Servo::kForceShare * device.maximum_torque * scale / gyration,
              Servo::kForceShare * device.maximum_grip}) {}

Motion WrenchGuard::rendered(const Vector3d& first, const Vector3d& turn,
                             double opening) const noexcept {
  Motion all = Motion::Zero();
  all.head<3>() = first;
  if (renders_torque_) all.segment<3>(3) = turn;
  if (renders_grip_) all[6] = opening;
  return all;
}

Wrench WrenchGuard::pass(const Guard::Input& input, const Turn& turn) noexcept {
  if (!started_) hand_ = turn.hand;
  started_ = true;
  turned_ += turn_between(hand_.orientation, turn.hand.orientation);
  opened_ += turn.hand.opening - hand_.opening;
  waited_ += input.dt;
  if (input.fresh) {
    opening_ = waited_ > 0 ? opened_ / waited_ : 0;
    opened_ = waited_ = 0;
  }
  hand_ = turn.hand;
  const Wrench& wrench = turn.wrench;
  WrenchAxes::Input all;
  all.force = rendered(input.force, wrench.torque / gyration_, wrench.grip);
  const Motion pressed = rendered(wrench.force, wrench.torque / gyration_, wrench.grip);
  if (!pressed.isZero(0)) all.normal = pressed.normalized();
  all.drift.head<3>() = input.drift;
  all.hip = rendered(input.hip, gyration_ * turned_, turn.hand.opening);
  all.velocity = rendered(input.velocity, gyration_ * turn.velocity, opening_);
  all.dt = input.dt;
  all.fresh = input.fresh;
  all.stiffness = input.stiffness;
  all.felt = input.felt;
  all.softened = input.softened;
  all.fault = input.fault;
  const Motion passed = chain_.pass(all);
  return {passed.head<3>(), gyration_ * passed.segment<3>(3), passed[6]};
}

void WrenchGuard::reset() noexcept {
  const bool failed = chain_.state().fault != Guard::Fault::none;
  chain_.reset();
  if (!failed) return;
  turned_.setZero();
  opened_ = waited_ = opening_ = 0;
  started_ = false;
}

}  // namespace palpate
