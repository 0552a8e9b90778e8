#pragma once

#include "palpate/device/device.hpp"

namespace palpate {

/// The stiffest wall, N/m, that gives no energy to a free device whatever the hand does
/// (Colgate and Schenkel 1997, with a delay): K = 2 b / (T + 2 T_d).
///
/// `damping`: of device and wall, N s/m. `period`: between steps, s. `delay`: from reading a place
/// to its force's effect, s, the hold of the force not counted.
[[nodiscard]] constexpr double passive_stiffness(double damping, double period,
                                                 double delay) noexcept {
  return 2 * damping / (period + 2 * delay);
}

/// The same of a device with a wall that damps with `damping` (N s/m). What a device does not tell
/// is taken on the safe side: no damping, a delay of a step. Infinite where it renders no force.
[[nodiscard]] double passive_stiffness(const DeviceInfo& device, double damping) noexcept;

}  // namespace palpate
