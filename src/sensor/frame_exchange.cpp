#include "sensor/frame_exchange.hpp"

#include <chrono>
#include <utility>

namespace palpate::sensor {

bool FrameExchange::wait_for_room() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || !lossless_ || !full_; });
  return !stopped_;
}

FrameExchange::Offer FrameExchange::offer(DepthFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (stopped_) return Offer::stopped;
  std::swap(frame_, frame);
  changed_.notify_all();
  return std::exchange(full_, true) ? Offer::overtook : Offer::taken;
}

bool FrameExchange::pause(double seconds) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                            [this] { return stopped_; });
}

void FrameExchange::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool FrameExchange::take(DepthFrame& frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || ended_ || full_; });
  if (stopped_ || !full_) return false;
  std::swap(frame_, frame);
  full_ = false;
  changed_.notify_all();
  return true;
}

bool FrameExchange::ended() {
  const std::lock_guard lock(mutex_);
  return ended_ && !full_;
}

void FrameExchange::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

}  // namespace palpate::sensor
