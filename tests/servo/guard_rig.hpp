#pragma once

#include <Eigen/Core>
#include <limits>

#include "palpate/servo/guard.hpp"

namespace palpate::test {

/// A guard with the links slew, clamp, fault and watchdog alone.
inline GuardOptions plain(double maximum_force = std::numeric_limits<double>::infinity()) {
  GuardOptions options;
  options.maximum_force = maximum_force;
  options.damping = 0;
  options.soft_start = 0;
  options.passivity.on = false;
  return options;
}

/// A millisecond's step with `force` (N) of a surface of 500 N/m that tells no normal.
inline Guard::Input pushed(const Eigen::Vector3d& force,
                           const Eigen::Vector3d& hip = Eigen::Vector3d::Zero()) {
  Guard::Input input;
  input.force = force;
  input.hip = hip;
  input.dt = 1e-3;
  input.stiffness = 500;
  return input;
}

}  // namespace palpate::test
