#include "palpate/device/paced.hpp"

namespace palpate {

PacedDevice::PacedDevice(Device& device, const Clock& clock)
    : device_(device), clock_(clock), info_(device.info()) {
  info_.keeps_time = false;
}

// Half a step of slack: steps of clock and device may fall together but for rounding.
DeviceState PacedDevice::read() noexcept {
  const double period = 1 / info_.rate;
  const double now = clock_.now();
  if (!started_) {
    started_ = true;
    state_ = device_.read();
    start_ = now - state_.time;
    return state_;
  }
  int steps = 0;
  while (!has_ended(state_.status) && state_.time + 0.5 * period <= now - start_) {
    if (++steps > kMostSteps) {
      start_ = now - state_.time;
      break;
    }
    state_ = device_.read();
  }
  return state_;
}

}  // namespace palpate
