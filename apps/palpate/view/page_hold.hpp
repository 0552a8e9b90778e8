// Holds one hand for a page.
#pragma once

#include <mutex>

#include "apps/palpate/run/run.hpp"
#include "palpate/base/clock.hpp"

namespace palpate::app {

/// A page's hold on one hand that can be taken.
class PageHold {
 public:
  /// The hand outlives it.
  explicit PageHold(Hand& hand) : hand_(hand) {}

  [[nodiscard]] bool possible() const { return hand_.remote != nullptr; }

  /// The rest is for hands that can be taken. `target`: world frame.
  void move(TargetSource::Target target) {
    const std::lock_guard lock(mutex_);
    held_ = true;
    target.position = hand_.workspace.position_to_device(target.position);
    target.orientation = hand_.workspace.orientation_to_device(target.orientation);
    target.opening /= hand_.workspace.scale;
    hand_.remote->move(target, clock_.now());
  }
  void release() {
    const std::lock_guard lock(mutex_);
    held_ = false;
    hand_.remote->release();
  }

  /// Another thread's, some tens of times a second: a page that has the tool still has it.
  void keep() {
    const std::lock_guard lock(mutex_);
    if (held_) hand_.remote->keep_alive();
  }

 private:
  Hand& hand_;
  SteadyClock clock_;  // of poses
  std::mutex mutex_;
  bool held_ = false;
};

}  // namespace palpate::app
