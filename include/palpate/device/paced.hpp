#pragma once

#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"

namespace palpate {

/// Lets a device that defines its own time (a simulation, a recording) run in that of a clock: each
/// read() brings it to the clock's time. Where the reader is late the device has gone on under the
/// force that was written last, as a real one would. Its time 0 is the first read().
class PacedDevice final : public Device {
 public:
  /// Steps that one read() catches up at most; the device's time falls back behind a longer gap.
  static constexpr int kMostSteps = 200;

  /// Both outlive it; nobody else uses the device.
  PacedDevice(Device& device, const Clock& clock);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override { device_.write(force); }
  [[nodiscard]] std::string reason() const override { return device_.reason(); }

 private:
  Device& device_;
  const Clock& clock_;
  DeviceInfo info_;
  DeviceState state_;
  double start_ = 0;  // the clock's time at the device's time 0, s
  bool started_ = false;
};

}  // namespace palpate
