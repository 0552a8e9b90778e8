#pragma once

#include <array>
#include <cstddef>

namespace palpate::test {

/// The hand of a device that a test makes up: a mass with friction, in the device's own axes.
struct FakeMass {
  using Three = std::array<double, 3>;
  static constexpr double kMass = 0.2;   // kg
  static constexpr double kDamping = 2;  // N s/m

  Three place{};     // m
  Three velocity{};  // m/s

  void advance(double time, const Three& force) {
    for (std::size_t i = 0; i < 3; ++i) {
      velocity[i] += time * (force[i] - kDamping * velocity[i]) / kMass;
      place[i] += time * velocity[i];
    }
  }
};

}  // namespace palpate::test
