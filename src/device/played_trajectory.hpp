#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "device/target_motion.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {

/// A trajectory that is played again and again, without those presses that the hand does not hold.
/// One thread uses it; real-time but for construction.
class PlayedTrajectory {
 public:
  /// `rows`: empty, or such that check() accepts it; `presses` in the order of their times.
  PlayedTrajectory(Trajectory rows, std::vector<Press> presses)
      : rows_(std::move(rows)), presses_(std::move(presses)) {
    if (!empty()) time_ = rows_.front().time;
  }

  [[nodiscard]] bool empty() const noexcept { return rows_.empty(); }

  /// The trajectory is not empty.
  [[nodiscard]] Pose pose() noexcept { return rows_.at(time_); }

  void advance(double dt) noexcept { time_ += dt; }

  /// Is it over? Then it begins again.
  [[nodiscard]] bool ends() noexcept {
    if (time_ < rows_.end()) return false;
    rows_.rewind();
    next_press_ = 0;
    time_ = rows_.front().time;
    return true;
  }

  /// The press in progress, if the hand, `pull` m from its target, has lost what it pressed or is
  /// caught; the trajectory goes on behind it. Otherwise null.
  [[nodiscard]] const Press* lost(double pull) noexcept {
    while (next_press_ < presses_.size() && presses_[next_press_].end < time_) ++next_press_;
    if (next_press_ == presses_.size()) return nullptr;
    const Press& press = presses_[next_press_];
    if (pull > press.pull || time_ < press.begin) held_at_ = time_;
    const bool caught = time_ >= press.begin && pull > kCaught * press.pull;
    if (!caught && time_ - held_at_ < kSettled) return nullptr;
    time_ = press.resume;
    return &press;
  }

  /// Is a press in progress or about to end? Then the trajectory goes on behind it.
  void leave_press() noexcept {
    if (next_press_ == presses_.size()) return;
    const Press& press = presses_[next_press_];
    if (time_ >= press.begin && time_ < press.resume) time_ = press.resume;
  }

 private:
  // s in which a hand that nothing holds is at its target: five time constants of 10 ms, the usual
  // hand's damping over its stiffness (SimulatedDeviceOptions::Hand)
  static constexpr double kSettled = 0.05;

  // times the pull of the shallowest press that is held at all: the deepest has 4 of it, and what
  // stays farther behind is caught by an edge, and would be thrown once that lets go
  static constexpr double kCaught = 8;

  Playback rows_;
  std::vector<Press> presses_;
  double time_ = 0;             // on the trajectory
  double held_at_ = 0;          // on the trajectory, when a press was held back last
  std::size_t next_press_ = 0;  // that is not over
};

}  // namespace palpate
