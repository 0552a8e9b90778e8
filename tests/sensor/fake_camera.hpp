#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "palpate/base/clock.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::sensor {

/// Time that a test sets.
class ManualClock final : public Clock {
 public:
  [[nodiscard]] double now() const noexcept override { return now_.load(); }
  void set(double now) { now_.store(now); }

 private:
  std::atomic<double> now_{0};
};

/// What a fake camera answers to one read().
struct Answer {
  DepthCamera::Status status = DepthCamera::Status::frame;
  DepthFrame frame{};
  std::string reason{};
  bool throws = false;
};

/// The other end of a fake camera: a test gives answers, one a read(); without one the camera
/// waits as a real one does.
class Script {
 public:
  void give(Answer answer) {
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(answer));
    changed_.notify_all();
  }

  [[nodiscard]] Answer next(double timeout) {
    std::unique_lock lock(mutex_);
    const bool any = changed_.wait_for(lock, std::chrono::duration<double>(timeout),
                                       [this] { return !answers_.empty(); });
    ++reads_;
    if (!any) return {.status = DepthCamera::Status::waiting};
    Answer answer = std::move(answers_.front());
    answers_.pop_front();
    return answer;
  }

  [[nodiscard]] int reads() {
    const std::lock_guard lock(mutex_);
    return reads_;
  }

  [[nodiscard]] std::size_t pending() {
    const std::lock_guard lock(mutex_);
    return answers_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Answer> answers_;
  int reads_ = 0;
};

class FakeCamera final : public DepthCamera {
 public:
  explicit FakeCamera(std::shared_ptr<Script> script, bool paces = true, bool repeats = false)
      : script_(std::move(script)),
        info_{.name = "fake", .rate = 30, .paces = paces, .repeats = repeats} {}

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  void begin(double start) override { begun_ = start; }
  /// When it was told to begin last.
  [[nodiscard]] std::optional<double> begun() const { return begun_; }
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override {
    Answer answer = script_->next(timeout);
    reason_ = answer.reason;
    if (answer.throws) throw std::runtime_error(answer.reason);
    if (answer.status == DepthCamera::Status::frame) frame = std::move(answer.frame);
    return answer.status;
  }
  [[nodiscard]] std::string reason() const override { return reason_; }

 private:
  std::shared_ptr<Script> script_;
  CameraInfo info_;
  std::optional<double> begun_;
  std::string reason_;
};

/// A frame of 4 x 3 pixels whose depths are `depth`, m.
inline DepthFrame frame_at(double stamp, float depth = 1, int width = 4, int height = 3) {
  DepthFrame frame;
  frame.camera = {.width = width,
                  .height = height,
                  .pinhole = {.fx = 4, .fy = 4, .cx = 1.5, .cy = 1},
                  .distortion = {}};
  frame.stamp = stamp;
  frame.depth.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), depth);
  return frame;
}

/// Waits until `condition` holds. False only if it has not after a time in which any machine gets
/// there.
[[nodiscard]] inline bool eventually(const std::function<bool()>& condition) {
  constexpr int kTries = 30'000;
  for (int i = 0; i < kTries; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace palpate::sensor
