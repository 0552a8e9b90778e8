#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {

/// Passes frames from a reading to a preparing thread; at most one frame waits. Frames are swapped,
/// so that their memory is reused.
class FrameExchange {
 public:
  /// `lossless`: the reader waits until its last frame is taken instead of overtaking it.
  explicit FrameExchange(bool lossless) : lossless_(lossless) {}

  enum class Offer { taken, overtook, stopped };

  /// Reader: waits until a frame may be read. False: stop.
  [[nodiscard]] bool wait_for_room() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || !lossless_ || !full_; });
    return !stopped_;
  }

  /// Reader: leaves a frame and gets an old one.
  [[nodiscard]] Offer offer(DepthFrame& frame) {
    const std::lock_guard lock(mutex_);
    if (stopped_) return Offer::stopped;
    std::swap(frame_, frame);
    changed_.notify_all();
    return std::exchange(full_, true) ? Offer::overtook : Offer::taken;
  }

  /// Reader: waits for some time, s of the host. False: stop.
  [[nodiscard]] bool pause(double seconds) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                              [this] { return stopped_; });
  }

  /// Reader: no frame will follow.
  void end() { set(ended_); }

  /// Preparer: waits for a frame. False: stop, or the end.
  [[nodiscard]] bool take(DepthFrame& frame) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || ended_ || full_; });
    if (stopped_ || !full_) return false;
    std::swap(frame_, frame);
    full_ = false;
    changed_.notify_all();
    return true;
  }

  [[nodiscard]] bool ended() {
    const std::lock_guard lock(mutex_);
    return ended_ && !full_;
  }

  /// Anyone: both are to stop.
  void stop() { set(stopped_); }

 private:
  void set(bool& flag) {
    const std::lock_guard lock(mutex_);
    flag = true;
    changed_.notify_all();
  }

  const bool lossless_;
  std::mutex mutex_;
  std::condition_variable changed_;
  DepthFrame frame_;
  bool full_ = false;
  bool ended_ = false;
  bool stopped_ = false;
};

}  // namespace palpate::sensor
