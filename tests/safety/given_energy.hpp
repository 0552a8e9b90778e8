#pragma once

#include <functional>

#include "palpate/device/simulated.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::test {

/// What a simulated hand was given by what it touched, beyond what it had put in and beyond what
/// moving surfaces did themselves.
struct GivenEnergy {
  double in_a_contact = 0;  ///< most, from the first touch to any moment until it left, J
  /// Most, from any moment of a contact to a later one, beyond what the force at the first was
  /// worth as a stretched spring's, the proxy's or the one that was sent, J.
  double beyond_the_spring = 0;
  double in_all = 0;         ///< most, from the beginning to any moment, J
  int contacts = 0;          ///< touches that were left again
  double largest_force = 0;  ///< N
  Guard::State::Counts counts;
};

/// Lets the hand of `device` touch `scene` through a servo until it has finished, at most `steps`
/// steps; `prepare(time)` is called before each.
[[nodiscard]] GivenEnergy given_energy(SimulatedDevice& device, Scene& scene,
                                       const ServoOptions& options, int steps,
                                       const std::function<void(double)>& prepare = {});

}  // namespace palpate::test
