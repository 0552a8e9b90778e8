#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace palpate {

/// When a snapshot holds.
struct FrameTiming {
  double stamp = 0;     ///< of the data that are new in it, s, the sensor's clock
  double start = 0;     ///< s, on the fields' clock; no earlier than the last snapshot's
  double duration = 0;  ///< how long the next one is going to be waited for, s
};

/// How far what began at `last` has gone at `time`, s, 0-1. Rounding does not keep it from
/// arriving.
[[nodiscard]] inline double progress(const FrameTiming& last, double time) {
  constexpr double kArrived = 1 - 1e-6;  // share; the rest is rounding (judgement)
  if (!(last.duration > 0)) return 1;
  const double share = std::clamp((time - last.start) / last.duration, 0.0, 1.0);
  return share > kArrived ? 1 : share;
}

/// The times of a source's snapshots: a snapshot lasts as long as frames are apart on average, so
/// that the next one finds it just arrived.
class FrameIntervalFilter {
 public:
  /// The moment of a frame with this stamp whose surface is to start at `start`, s.
  [[nodiscard]] FrameTiming next(double stamp, double start) {
    if (frames_ > 0) measure(stamp);
    // Two snapshots with one start are in order all the same: the newer one goes on from where the
    // older one is then.
    if (frames_ > 0) start = std::max(start, last_start_);
    last_stamp_ = stamp;
    last_start_ = start;
    ++frames_;
    return {stamp, start, interval_};
  }

  /// Smoothed time between frames, s; a thirtieth until there have been two.
  [[nodiscard]] double interval() const { return interval_; }

 private:
  static constexpr int kMemory = 8;  // frames (judgement; docs/method.md 7.1)
  // A gap counts as so many intervals at most, and as so few at least
  // (judgement; docs/method.md 7.1).
  static constexpr double kOutlier = 2;
  static constexpr double kShortest = 1e-3;  // s
  static constexpr double kLongest = 2;      // s (judgement)

  void measure(double stamp) {
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

  double interval_ = 1. / 30;
  double last_stamp_ = 0;
  double last_start_ = 0;
  int frames_ = 0;
};

/// How old a camera's frame becomes until the next one replaces it, unless that one is lost.
class FrameLifetime {
 public:
  /// A frame was replaced at this age by one whose stamp is so much later, s.
  void add(double gap, double age) { ends_[count_++ % kFrames] = {gap, age}; }

  /// Between stamps where no frame is lost, s. Nothing: too few have come.
  [[nodiscard]] std::optional<double> interval() const {
    const std::size_t known = std::min(count_, kFrames);
    if (known < kFrames / 2) return std::nullopt;
    std::array<End, kFrames> ends = ends_;
    const auto quarter = ends.begin() + static_cast<std::ptrdiff_t>(known / 4);
    std::nth_element(ends.begin(), quarter, ends.begin() + static_cast<std::ptrdiff_t>(known),
                     [](const End& a, const End& b) { return a.gap < b.gap; });
    return quarter->gap;
  }

  /// The age that no frame exceeds while none is lost: the mean and three deviations of the last
  /// ones, s; below 0 where the camera's clock is ahead. Nothing: too few have come.
  [[nodiscard]] std::optional<double> longest() const {
    const std::optional<double> interval = this->interval();
    if (!interval) return std::nullopt;
    const auto end = ends_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kFrames));
    double count = 0, sum = 0, squares = 0;
    for (auto i = ends_.begin(); i != end; ++i) {
      if (i->gap > kLost * *interval) continue;
      const double before = count > 0 ? sum / count : 0;
      sum += i->age;
      count += 1;
      squares += (i->age - before) * (i->age - sum / count);
    }
    return sum / count + kDeviations * std::sqrt(squares / std::max(count - 1, 1.0));
  }

  /// Intervals: a longer gap has lost frames. Half way from one to the two of one that is lost.
  static constexpr double kLost = 1.5;

 private:
  // The end of a frame's time.
  struct End {
    double gap = 0;  // to the next one's stamp, s
    double age = 0;  // its own then, s
  };

  // Frames: their deviation is known to a sixth, 1 / sqrt(2 n).
  static constexpr std::size_t kFrames = 16;
  static constexpr double kDeviations = 3;  // as many as noise is allowed (Sight)

  std::array<End, kFrames> ends_;
  std::size_t count_ = 0;  // of all that came
};

}  // namespace palpate
