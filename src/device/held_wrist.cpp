// Integrates a simulated wrist in parts of a step.
#include "device/held_wrist.hpp"

#include "base/requirement.hpp"
#include "geometry/turn.hpp"

namespace palpate {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Parts of a step. A hand's spring on the default wrist turns by 3e-3 rad of its phase in one, so
// what the symplectic rule errs by is 1e-5 of its energy.
constexpr int kWristParts = 16;

SimulatedWrist checked_wrist(const SimulatedWrist& o) {
  const Requirement require{"simulated device"};
  require.positive("wrist.inertia", o.inertia.minCoeff(), "give positive kg m2 about each axis");
  require.not_negative("wrist.damping", o.damping, "give 0 or more N m s/rad");
  require.not_negative("wrist.coulomb", o.coulomb, "give 0 or more N m");
  require.not_negative("wrist.resolution", o.resolution, "give 0 or more radians");
  require.not_negative("wrist.maximum_torque", o.maximum_torque, "give 0 or more N m");
  require.not_negative("wrist.hand.stiffness", o.hand.stiffness, "give 0 or more N m/rad");
  require.not_negative("wrist.hand.damping", o.hand.damping, "give 0 or more N m s/rad");
  require.positive("wrist.hand.maximum_torque", o.hand.maximum_torque, "give a positive torque");
  constexpr double kRounded = 1e-6;  // of a quaternion's length, by six digits
  const double length = o.orientation.norm();
  require(std::abs(length - 1) <= kRounded, "wrist.orientation", length, "give unit length");
  require(o.velocity.allFinite() && o.inertia.allFinite(), "wrist.velocity", o.velocity.norm(),
          "give finite numbers");
  return o;
}

}  // namespace

HeldWrist::HeldWrist(const SimulatedWrist& options)
    : options_(checked_wrist(options)),
      orientation_(options.orientation.normalized()),
      rate_(orientation_.conjugate() * options.velocity) {}

void HeldWrist::advance(const Quaterniond& from, const Quaterniond& to, const Vector3d& torque,
                        double duration) noexcept {
  const Vector3d rotation = turn_between(from, to);
  const double part = duration / kWristParts;
  for (int i = 0; i < kWristParts; ++i) {
    const Quaterniond goal = turned(from, (i + 1.0) / kWristParts * rotation);
    const Quaterniond before = orientation_;
    turn(torque + pull(goal, rotation / duration), part);
    work_ += torque.dot(turn_between(before, orientation_));
  }
}

// The hand's own damper only brakes; the limit applies to the rest, its pull. Device's axes.
Vector3d HeldWrist::pull(const Quaterniond& goal, const Vector3d& goal_rate) const noexcept {
  const SimulatedWrist::Hand& hand = options_.hand;
  const Vector3d pull =
      hand.stiffness * turn_between(orientation_, goal) + hand.damping * goal_rate;
  const double size = pull.norm();
  return size > hand.maximum_torque ? Vector3d(hand.maximum_torque / size * pull) : pull;
}

// Euler's equation with dampers and dry friction at the rate of the part's end, which can stop a
// wrist but not turn it round.
void HeldWrist::turn(const Vector3d& torque, double duration) noexcept {
  const Vector3d& inertia = options_.inertia;
  const Vector3d spin = inertia.cwiseProduct(rate_);
  const Vector3d driven = spin + duration * (orientation_.conjugate() * torque - rate_.cross(spin));
  const double friction = duration * options_.coulomb;
  const double size = driven.norm();
  const double left = size > friction ? 1 - friction / size : 0;
  const double damped = duration * (options_.damping + options_.hand.damping);
  rate_ = (left * driven).cwiseQuotient((inertia.array() + damped).matrix());
  orientation_ = turned(orientation_, duration * (orientation_ * rate_));
}

Quaterniond HeldWrist::shown() const noexcept {
  if (options_.resolution == 0) return orientation_;
  const Vector3d turn = turn_between(Quaterniond::Identity(), orientation_);
  return turned(Quaterniond::Identity(),
                (turn / options_.resolution).array().round().matrix() * options_.resolution);
}

}  // namespace palpate
