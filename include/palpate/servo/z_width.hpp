#pragma once

#include "palpate/device/simulated.hpp"
#include "palpate/servo/guard.hpp"

namespace palpate {

/// A flat virtual wall that is rendered through a guard on a simulated device that nobody holds:
/// how stiff may it be? (Colgate and Brown 1994: the Z-width.)
struct WallOptions {
  SimulatedDeviceOptions device = {};  ///< its hand and place are left out of account
  GuardOptions guard = {};             ///< of which the stiffness limit is left out of account
  double stiffness = 500;              ///< K, N/m
  double speed = 0.1;                  ///< with which the device meets the wall, m/s
  double stretch = 5e-3;               ///< of the spring from which oscillations begin, m
};

/// What a device that flew into the wall came out with.
struct Impact {
  double rebound = 0;  ///< speed out over speed in; 0: it stayed within the wall for 2 s
  double energy = 0;   ///< that the forces gave to the device in all, J; below zero: took
};

/// A free flight into the wall and out again.
/// @throws Error when an option is out of its range.
[[nodiscard]] Impact impact(const WallOptions& wall);

/// Let go from `stretch`, where the wall holds from both sides: the oscillation after 2 s over that
/// at the beginning. Above 1 the wall is unstable.
/// @throws Error when an option is out of its range.
[[nodiscard]] double growth(const WallOptions& wall);

/// The largest stiffness, N/m, within a percent, at which oscillations do not grow.
/// `wall.stiffness` is not looked at; at most kStiffestWall.
[[nodiscard]] double stable_stiffness(WallOptions wall);

/// The largest, N/m, within a percent, at which no impact comes out faster than it went in.
[[nodiscard]] double rebound_stiffness(WallOptions wall);

inline constexpr double kStiffestWall = 1e5;  ///< N/m that is looked for

}  // namespace palpate
