// Plays a recording as a camera, in real time or as fast as it is read.
#include "sensor/played_camera.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace palpate::sensor {

PlayedCamera::PlayedCamera(CameraInfo info, std::unique_ptr<Recording> recording,
                           const CameraOptions& options)
    : info_(std::move(info)), recording_(std::move(recording)), options_(options) {
  info_.paces = options.clock != nullptr;
}

void PlayedCamera::begin(double start) {
  recording_->rewind();
  start_ = start;
  lap_ = 0;
  any_ = false;
  loaded_ = false;
}

DepthCamera::Status PlayedCamera::read(DepthFrame& frame, double timeout) {
  reason_.clear();
  if (!start_) start_ = options_.clock != nullptr ? options_.clock->now() : 0;
  load();  // beforehand, so that it is there when its time comes
  if (status_ == DepthCamera::Status::ended) return status_;
  const double time = *start_ + lap_ + time_;
  if (!wait(time, timeout)) return DepthCamera::Status::waiting;
  loaded_ = false;
  reason_ = std::exchange(why_, "");
  if (status_ != DepthCamera::Status::frame) return status_;
  std::swap(frame, frame_);
  frame.stamp = time;
  return status_;
}

void PlayedCamera::load() {
  if (std::exchange(loaded_, true)) return;
  const double last = time_;
  status_ = recording_->next(frame_, time_, why_);
  if (status_ == DepthCamera::Status::ended && options_.loop && std::exchange(any_, false)) {
    lap_ += last + 1 / info_.rate;
    recording_->rewind();
    status_ = recording_->next(frame_, time_, why_);
  }
  any_ |= status_ != DepthCamera::Status::ended;
}

bool PlayedCamera::wait(double time, double timeout) const {
  if (options_.clock == nullptr) return true;
  const double early = time - options_.clock->now();
  if (early <= 0) return true;
  if (timeout <= 0) return false;
  std::this_thread::sleep_for(std::chrono::duration<double>(std::min(early, timeout)));
  return options_.clock->now() >= time;
}

}  // namespace palpate::sensor
