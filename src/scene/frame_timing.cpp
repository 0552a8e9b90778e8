#include "scene/frame_timing.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr int kMemory = 8;      // frames
constexpr double kOutlier = 2;  // a gap counts as so many intervals at most, and as so few at least
constexpr double kShortest = 1e-3;  // s
constexpr double kLongest = 2;

}  // namespace

FrameTiming FrameIntervalFilter::next(double stamp, double start) {
  if (frames_ > 0) measure(stamp);
  // Two snapshots with one start are in order all the same: the newer one goes on from where the
  // older one is then.
  if (frames_ > 0) start = std::max(start, last_start_);
  last_stamp_ = stamp;
  last_start_ = start;
  ++frames_;
  return {stamp, start, interval_};
}

void FrameIntervalFilter::measure(double stamp) {
  const double gap = stamp - last_stamp_;
  if (!(gap > 0)) return;
  if (frames_ == 1) {
    interval_ = std::clamp(gap, kShortest, kLongest);
    return;
  }
  const double believed = std::clamp(gap, interval_ / kOutlier, interval_ * kOutlier);
  interval_ += (believed - interval_) / std::min(frames_, kMemory);
  interval_ = std::clamp(interval_, kShortest, kLongest);
}

}  // namespace palpate
