#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate::test {

/// A clock that the test moves. Any thread.
class MovedClock final : public WaitingClock {
 public:
  [[nodiscard]] double now() const noexcept override { return now_.load(); }
  void wait_until(double time) noexcept override { now_ = std::max(now_.load(), time); }

 private:
  std::atomic<double> now_ = 100;
};

/// What a driver may meet: a hand at a place, a motor that holds the last force, and faults. Its
/// own watchdog lets the motor go when nothing is heard, as those of real devices do.
class FakeHardware {
 public:
  enum class Fault {
    none,
    absent,        ///< not plugged in
    busy,          ///< in use by another program
    uncalibrated,  ///< does not know where its hand is
    error,         ///< answers with an error's code
    not_a_number,  ///< tells places that are none
    not_a_turn,    ///< tells orientations that are none
  };

  explicit FakeHardware(WaitingClock& clock) : clock_(clock) {}

  void set(Fault fault) {
    const std::lock_guard lock(mutex_);
    fault_ = fault;
    if (fault == Fault::absent) force_.setZero();
  }
  /// The next exchange takes so long, s.
  void block(double duration) {
    const std::lock_guard lock(mutex_);
    block_ = duration;
  }
  void move(const Eigen::Vector3d& place) {
    const std::lock_guard lock(mutex_);
    place_ = place;
  }
  void turn(const Eigen::Quaterniond& orientation) {
    const std::lock_guard lock(mutex_);
    orientation_ = orientation;
  }
  void rename(std::string name) {
    const std::lock_guard lock(mutex_);
    name_ = std::move(name);
  }

  /// What the motor holds, N.
  [[nodiscard]] Eigen::Vector3d force() const {
    const std::lock_guard lock(mutex_);
    const bool heard = clock_.now() - heard_ <= kWatchdog;
    return heard ? force_ : Eigen::Vector3d::Zero().eval();
  }
  /// What it was told last, N m and N.
  [[nodiscard]] Wrench told() const {
    const std::lock_guard lock(mutex_);
    return told_;
  }
  [[nodiscard]] int opened() const { return opened_; }
  [[nodiscard]] int closed() const { return closed_; }
  [[nodiscard]] std::string name() const {
    const std::lock_guard lock(mutex_);
    return name_;
  }

  void open() {
    require();
    ++opened_;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    force_.setZero();
    ++closed_;
  }
  DeviceState exchange(const Wrench& wrench) {
    const double block = apply(wrench);
    if (block > 0) clock_.wait_until(clock_.now() + block);
    require();
    const std::lock_guard lock(mutex_);
    DeviceState reading{.position = place_,
                        .velocity = {0, 0, -0.1},
                        .buttons = 1,
                        .orientation = orientation_,
                        .gripper = 0.02};
    if (fault_ == Fault::not_a_number) {
      reading.position.y() = std::numeric_limits<double>::quiet_NaN();
    }
    if (fault_ == Fault::not_a_turn) {
      reading.orientation.x() = std::numeric_limits<double>::quiet_NaN();
    }
    return reading;
  }

 private:
  static constexpr double kWatchdog = 5e-3;  // s

  double apply(const Wrench& wrench) {
    const std::lock_guard lock(mutex_);
    heard_ = clock_.now();
    if (!refuses()) force_ = wrench.force;
    told_ = wrench;
    return std::exchange(block_, 0);
  }
  [[nodiscard]] bool refuses() const {
    return fault_ != Fault::none && fault_ != Fault::not_a_number && fault_ != Fault::not_a_turn;
  }
  void require() const {
    const std::lock_guard lock(mutex_);
    switch (fault_) {
      case Fault::absent:
        throw Error("fake: not there; plug it in");
      case Fault::busy:
        throw Error("fake: in use; end the other program");
      case Fault::uncalibrated:
        throw Error("fake: not calibrated; move it to its stops");
      case Fault::error:
        throw Error("fake: error 7; switch it off and on");
      case Fault::none:
      case Fault::not_a_number:
      case Fault::not_a_turn:
        return;
    }
  }

  WaitingClock& clock_;
  mutable std::mutex mutex_;
  std::string name_ = "fake";
  Fault fault_ = Fault::none;
  double block_ = 0;
  double heard_ = 0;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation_{0.6, 0, 0.8, 0};
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Wrench told_;
  std::atomic<int> opened_ = 0;
  std::atomic<int> closed_ = 0;
};

class FakeDriver final : public DeviceDriver {
 public:
  explicit FakeDriver(FakeHardware& hardware) : hardware_(hardware) {
    hardware_.open();
    info_.name = hardware_.name();
    info_.maximum_force = 5;
    info_.maximum_torque = 0.1;
    info_.maximum_grip = 3;
    info_.rate = 2000;
  }
  ~FakeDriver() override { hardware_.close(); }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Eigen::Vector3d& force) override {
    return hardware_.exchange({.force = force});
  }
  [[nodiscard]] DeviceState exchange_wrench(const Wrench& wrench) override {
    return hardware_.exchange(wrench);
  }

 private:
  FakeHardware& hardware_;
  DeviceInfo info_;
};

}  // namespace palpate::test
