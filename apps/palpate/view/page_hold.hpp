// Holds one hand for a page.
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>

#include "apps/palpate/run/run.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/servo/servo.hpp"
#include "session/led_hand.hpp"

namespace palpate::app {

/// A page's hold on one hand that can be taken.
class PageHold {
 public:
  /// All outlive it. `servo`: the hand's.
  PageHold(Hand& hand, const Scene& scene, const Servo& servo) : hand_(hand), servo_(servo) {
    if (possible()) led_.emplace(*hand.remote, hand.workspace, scene);
  }

  [[nodiscard]] bool possible() const { return hand_.remote != nullptr; }

  /// The rest is for hands that can be taken. As session::LedHand::move().
  void move(const TargetSource::Target& target, const std::optional<Eigen::Vector3d>& eye) {
    const std::lock_guard lock(mutex_);
    held_ = true;
    led_->move(target, eye, servo_, clock_.now());
  }
  void release() {
    const std::lock_guard lock(mutex_);
    held_ = false;
    led_->release();
  }

  /// Another thread's, some tens of times a second: a page that has the tool still has it.
  void keep() {
    const std::lock_guard lock(mutex_);
    if (held_) hand_.remote->keep_alive();
  }

 private:
  Hand& hand_;
  const Servo& servo_;
  std::optional<session::LedHand> led_;  // where it can be taken
  SteadyClock clock_;                    // of poses
  std::mutex mutex_;
  bool held_ = false;
};

}  // namespace palpate::app
