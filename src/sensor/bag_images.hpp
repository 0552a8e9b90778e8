// Holds images of a bag until they can be shown, and returns when each is due.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "bag/mcap_format.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "sensor/ros_frames.hpp"

namespace palpate::sensor {

inline constexpr double kNanosecond = 1e-9;  ///< s

/// Times of images, s: as their stamps state, or, where those stand still or jump, as they were
/// recorded.
class ImageTimes {
 public:
  /// `log`: when it was recorded, ns. The first image's time is 0.
  double next(double stamp, std::uint64_t log) {
    const double recorded = kNanosecond * static_cast<double>(log - log_);
    const double stamped = stamp - stamp_;
    stamp_ = stamp;
    log_ = log;
    if (std::exchange(any_, true)) {
      time_ += stamped > 0 && stamped < recorded + kJump ? stamped : recorded;
    }
    return time_;
  }
  /// The last image's.
  [[nodiscard]] double last() const { return time_; }

 private:
  static constexpr double kJump = 1;  // s that stamps may run ahead of the recording (judgement)

  bool any_ = false;
  double time_ = 0;
  double stamp_ = 0;
  std::uint64_t log_ = 0;
};

/// An image or cloud as it is in the file.
struct BagImage {
  void (*fill)(const RosFrames&, bag::View, DepthFrame&) = nullptr;
  message::Header header;
  std::uint64_t log = 0;  ///< ns
  bag::Bytes data;
};

/// Images that wait for their transforms.
class WaitingImages {
 public:
  [[nodiscard]] bool empty() const { return images_.empty(); }
  [[nodiscard]] const BagImage& front() const { return images_.front(); }
  [[nodiscard]] bool full() const { return images_.size() >= kMost || held_ >= kMostHeld; }

  void push(BagImage image) {
    held_ += image.data.size();
    images_.push_back(std::move(image));
  }
  [[nodiscard]] BagImage pop() {
    BagImage image = std::move(images_.front());
    images_.pop_front();
    held_ -= image.data.size();
    return image;
  }

 private:
  static constexpr std::size_t kMost = 64;             // judgement
  static constexpr std::size_t kMostHeld = 256 << 20;  // bytes of them (judgement)

  std::deque<BagImage> images_;
  std::size_t held_ = 0;  // bytes of those
};

}  // namespace palpate::sensor
