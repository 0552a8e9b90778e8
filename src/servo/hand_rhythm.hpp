// Tells how often a hand is read, and how stiff a surface it bears at that.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate/device/device.hpp"

namespace palpate {

/// Readings of a hand as they come, against the rate that its device told. Real-time.
class HandRhythm {
 public:
  /// `rate`: the device's, Hz.
  explicit HandRhythm(double rate) noexcept : period_(rate > 0 ? 1 / rate : 0) {}

  /// A step, `dt` (s) after the last one.
  void take(const DeviceState& read, double dt) noexcept {
    const bool known = read.status == DeviceState::Status::ok;
    const bool repeated = read.time != 0 && read.time == read_ && read.position == position_;
    fresh_ = !(known && known_ && repeated);
    const bool goes_on = known && known_ && std::isfinite(dt) && dt >= 0;
    read_ = read.time;
    position_ = read.position;
    known_ = known;
    if (!goes_on) time_ = late_ = waited_ = 0;
    if (goes_on) waited_ += dt;
    if (fresh_ && goes_on) add(waited_, std::max(0.0, waited_ - std::max(dt, period_)));
  }

  /// Was the hand read in that step? A device that repeats the time of its last reading holds it;
  /// one that tells no time is read in each step.
  [[nodiscard]] bool is_fresh() const noexcept { return fresh_; }

  /// s by which readings are further apart than the device told, on average over time: K of a
  /// spring whose hand moves on for t_i between readings gives K sum t_i^2 where a damper takes
  /// B sum t_i, so what counts is sum t_i^2 / sum t_i. Exactly 0 while each step is a reading.
  [[nodiscard]] double late() const noexcept { return time_ > 0 ? late_ / time_ : 0; }
  /// s
  [[nodiscard]] double period() const noexcept { return period_ + late(); }

 private:
  // s in which the past falls to 1/e: as in the ledger of energy (GuardOptions::Passivity)
  static constexpr double kMemory = 1;

  void add(double time, double late) noexcept {
    const double left = std::exp(-time / kMemory);
    time_ = left * time_ + time;
    late_ = left * late_ + time * late;
    waited_ = 0;
  }

  double period_;  // s
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  double read_ = 0;     // time of the last reading on the device's clock, s
  double waited_ = 0;   // s since then
  double time_ = 0;     // s, weighted
  double late_ = 0;     // s2, the same
  bool known_ = false;  // the hand was, in the step before
  bool fresh_ = true;
};

}  // namespace palpate
