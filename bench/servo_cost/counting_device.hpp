#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "palpate/device/device.hpp"

namespace palpate::servo_cost {

/// Counts how often its thread slept. Every step of a paced servo waits for the clock once, at
/// most.
class CountingDevice final : public Device {
 public:
  explicit CountingDevice(Device& device) : device_(device) {}
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return device_.info(); }
  [[nodiscard]] DeviceState read() noexcept override {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    if (reads_ == 0) first_ = usage.ru_nvcsw;
    slept_ = usage.ru_nvcsw - first_;
    ++reads_;
    return device_.read();
  }
  void write(const Eigen::Vector3d& force) noexcept override { device_.write(force); }
  void write_wrench(const Wrench& wrench) noexcept override { device_.write_wrench(wrench); }
  [[nodiscard]] std::string reason() const override { return device_.reason(); }

  /// Times it slept for anything but the clock. After the last read.
  [[nodiscard]] std::int64_t other_waits() const {
    return std::max<std::int64_t>(slept_ - (reads_ - 1), 0);
  }

 private:
  Device& device_;
  std::int64_t reads_ = 0;
  std::int64_t first_ = 0;
  std::int64_t slept_ = 0;
};

}  // namespace palpate::servo_cost
