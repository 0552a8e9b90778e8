#include "palpate/servo/passive_stiffness.hpp"

#include <limits>

namespace palpate {

double passive_stiffness(const DeviceInfo& device, double damping) noexcept {
  if (!(device.maximum_force > 0) || !(device.rate > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double period = 1 / device.rate;
  return passive_stiffness(device.damping + damping, period, device.delay.value_or(period));
}

}  // namespace palpate
