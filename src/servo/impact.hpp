#pragma once

#include "palpate/servo/z_width.hpp"

namespace palpate {

/// What a device that flew into the wall came out with.
struct Impact {
  double rebound = 0;  ///< speed out over speed in; 0: it stayed within the wall for 2 s
  double energy = 0;   ///< that the forces gave to the device in all, J; below zero: took
};

/// A free flight into the wall and out again.
/// @throws Error when an option is out of its range.
[[nodiscard]] Impact impact(const WallOptions& wall);

}  // namespace palpate
