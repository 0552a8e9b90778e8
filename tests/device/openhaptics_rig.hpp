#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "device/double_library.hpp"
#include "device/fake_hardware.hpp"
#include "device/fake_hd.hpp"
#include "device/openhaptics_scheduler.hpp"
#include "palpate/base/error.hpp"

namespace palpate::test {

inline const std::string kDouble = PALPATE_FAKE_HD;
inline const std::string kTouch = "openhaptics,library=" + kDouble;
inline const std::string kOther = "openhaptics:Other,library=" + kDouble;
inline const Eigen::Vector3d kPush(0.2, 0.4, 0.6);  // N; a Touch bears 0.88

/// A link whose scheduler ticks once for each exchange, and whenever it is told.
class SteppedDriver final : public DeviceDriver {
 public:
  SteppedDriver(const DoubleLibrary& library, const Clock& clock, const std::string& name)
      : library_(library) {
    link_ = std::make_unique<device::OpenHapticsDriver>(device::parse_device_name(name), clock);
    library_.flag("fake_by_itself", false);
  }
  ~SteppedDriver() override { library_.flag("fake_by_itself", true); }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return link_->info(); }
  [[nodiscard]] DeviceState exchange(const Eigen::Vector3d& force) override {
    return exchange_wrench({.force = force});
  }
  [[nodiscard]] DeviceState exchange_wrench(const Wrench& wrench) override {
    link_->request(wrench);
    library_.find<void(int)>("fake_tick")(1);
    return link_->answer();
  }
  device::OpenHapticsDriver& link() { return *link_; }

 private:
  const DoubleLibrary& library_;
  std::unique_ptr<device::OpenHapticsDriver> link_;
};

/// The driver before the double.
class OpenHapticsRig : public testing::Test {
 protected:
  OpenHapticsRig() { library_.reset(); }

  [[nodiscard]] std::unique_ptr<SteppedDriver> open(const std::string& name = kTouch) {
    return std::make_unique<SteppedDriver>(library_, clock_, name);
  }
  /// One whose scheduler ticks by itself.
  [[nodiscard]] std::unique_ptr<device::OpenHapticsDriver> open_running(const std::string& name) {
    return std::make_unique<device::OpenHapticsDriver>(device::parse_device_name(name), clock_);
  }
  [[nodiscard]] std::string refusal(const std::string& name = kTouch) {
    try {
      (void)open(name);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  void tick(int count) const { library_.find<void(int)>("fake_tick")(count); }
  void set() const { library_.find<void(const FakeHd*)>("fake_set")(&hardware_); }
  /// Sets one thing of the hardware.
  template <class Member, class Value>
  void set(Member member, const Value& value) {
    hardware_.*member = value;
    set();
  }
  [[nodiscard]] bool runs() const { return library_.find<bool()>("fake_runs")(); }
  void pass(double time) { clock_.wait_until(clock_.now() + time); }

  DoubleLibrary library_{kDouble};
  FakeHd hardware_;
  MovedClock clock_;
};

}  // namespace palpate::test
