#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "device/fake_hardware.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate::test {

/// A driver's device with the servo's side before it, in simulated time: what each fault does to
/// the force that the hand is to feel.
class FaultTrial {
 public:
  struct Hardware {
    ThreadedDevice::Open open;
    std::function<void(double time)> advance;  ///< the device's time, s
    std::function<double()> force;             ///< what its motors hold, N
    double period = 1e-3;                      ///< of its exchanges, s; a step has a whole number
  };

  FaultTrial(Hardware hardware, MovedClock& clock, const Eigen::Vector3d& wanted)
      : hardware_(std::move(hardware)),
        clock_(clock),
        wanted_(wanted),
        device_([this] { return open(); }, clock, {.threaded = false}) {}

  void run(double duration, bool served = true) {
    for (const double end = clock_.now() + duration; clock_.now() < end - 1e-9;) {
      if (served) device_.service();
      if (++exchanges_ % steps_ == 0) step();
      hardware_.advance(hardware_.period);
      clock_.wait_until(clock_.now() + hardware_.period);
      if (!is_free()) pushed_ = clock_.now();
    }
  }
  /// Runs for half a second with a fault, and until it is opened again without.
  void expect_lost(const std::string& fault, const std::function<void(bool)>& set,
                   const std::string& word) {
    reasons_.clear();
    const double start = clock_.now();
    set(true);
    run(0.5);
    EXPECT_LE(pushed_ - start, 6e-3) << fault;
    EXPECT_THAT(reasons_, testing::ElementsAre(testing::HasSubstr(word))) << fault;
    set(false);
    run(1.2);
    EXPECT_TRUE(is_pushed()) << fault << " is over";
  }

  [[nodiscard]] bool is_pushed() const { return hardware_.force() > 0.9 * wanted_.norm(); }
  [[nodiscard]] bool is_free() const { return hardware_.force() == 0; }
  /// When the hand felt a force last, s.
  [[nodiscard]] double pushed() const { return pushed_; }
  /// Why there was none since the last fault, or forget().
  [[nodiscard]] const std::set<std::string>& reasons() const { return reasons_; }
  void forget() { reasons_.clear(); }
  [[nodiscard]] ThreadedDevice& device() { return device_; }
  /// How often the hardware was lost and opened again.
  [[nodiscard]] int reopened() const { return opened_ - 1; }

 private:
  std::unique_ptr<DeviceDriver> open() {
    std::unique_ptr<DeviceDriver> driver = hardware_.open();
    ++opened_;
    return driver;
  }
  void step() {
    const DeviceState state = device_.read();
    if (state.status == DeviceState::Status::silent) reasons_.insert(device_.reason());
    device_.write(state.status == DeviceState::Status::ok ? wanted_
                                                          : Eigen::Vector3d::Zero().eval());
  }

  Hardware hardware_;
  MovedClock& clock_;
  Eigen::Vector3d wanted_;
  int opened_ = 0;
  ThreadedDevice device_;
  std::set<std::string> reasons_;
  double pushed_ = 0;
  int exchanges_ = 0;
  int steps_ = static_cast<int>(std::lround(1e-3 / hardware_.period));
};

}  // namespace palpate::test
