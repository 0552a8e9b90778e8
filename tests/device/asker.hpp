#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "palpate/device/simulated.hpp"

namespace palpate::test {

inline constexpr double kAskedEvery = 1e-3;  // s

// Asks a guided hand every millisecond and remembers its fastest step.
class Asker {
 public:
  Asker(TeleoperatedHand& hand, const Eigen::Vector3d& device) : hand_(hand), device_(device) {}

  TargetSource::Target ask() {
    const TargetSource::Target wish = hand_.target(now_, device_);
    if (step_ > 0)
      fastest_ = std::max(fastest_, (wish.position - last_.position).norm() / kAskedEvery);
    last_ = wish;
    now_ = ++step_ * kAskedEvery;
    return wish;
  }
  TargetSource::Target ask_until(double time) {
    while (now_ < time - 0.5 * kAskedEvery) ask();
    return last_;
  }

  // The device is where it is wanted.
  TargetSource::Target follow_until(double time) {
    while (now_ < time - 0.5 * kAskedEvery) device_ = ask().position;
    return last_;
  }

  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] double fastest() const { return fastest_; }
  void device_at(const Eigen::Vector3d& position) { device_ = position; }

 private:
  TeleoperatedHand& hand_;
  Eigen::Vector3d device_;
  TargetSource::Target last_;
  double now_ = 0;
  double fastest_ = 0;
  int step_ = 0;
};

}  // namespace palpate::test
