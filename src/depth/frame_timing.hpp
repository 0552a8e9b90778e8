#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>

namespace palpate {

/// The time between a usual camera's frames, s (judgement).
inline constexpr double kUsualInterval = 1. / 30;

/// When a snapshot holds.
struct FrameTiming {
  double stamp = 0;     ///< of the data that are new in it, s, the sensor's clock
  double start = 0;     ///< s, on the fields' clock; no earlier than the last snapshot's
  double duration = 0;  ///< how long the next one is going to be waited for, s
  double spare = 0;     ///< time between frames in which none was being prepared, smoothed, s
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
    return {stamp, start, interval_, spare_};
  }

  /// Smoothed time between frames, s; kUsualInterval until there have been two.
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
    if (frames_ == 1) interval_ = gap;
    const double believed = std::clamp(gap, interval_ / kOutlier, interval_ * kOutlier);
    const double late = last_start_ - last_stamp_;
    const int share = std::min(frames_, kMemory);
    interval_ = std::clamp(interval_ + (believed - interval_) / share, kShortest, kLongest);
    const double left = std::clamp(std::min(gap, believed) - late, 0.0, kLongest);
    spare_ += (left - spare_) / share;
  }

  double interval_ = kUsualInterval;
  double spare_ = 0;  // smoothed alike
  double last_stamp_ = 0;
  double last_start_ = 0;
  int frames_ = 0;
};

/// How old a camera's frame becomes until the next one replaces it, unless that one is lost.
class FrameLifetime {
 public:
  /// A frame came: how much later than the one before its stamp is, and how old it was when it was
  /// first read, s.
  void add(double gap, double delay) {
    frames_[count_++ % kFrames] = {gap, delay};
    quickest_ = std::min(quickest_ + kDrift * std::max(gap, 0.0), delay);
  }

  /// Between stamps where no frame is lost, s. Nothing: too few have come.
  [[nodiscard]] std::optional<double> interval() const {
    const std::size_t count = known();
    if (count < kFrames / 2) return std::nullopt;
    std::array<Frame, kFrames> frames = frames_;
    const auto quarter = frames.begin() + static_cast<std::ptrdiff_t>(count / 4);
    std::nth_element(frames.begin(), quarter, frames.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const Frame& a, const Frame& b) { return a.gap < b.gap; });
    return quarter->gap;
  }

  /// The age that a frame may reach while none is lost, s: the longest gap and the longest delay of
  /// the last ones. Nothing: too few have come.
  [[nodiscard]] std::optional<double> longest() const {
    const std::optional<double> gap = longest_gap();
    if (!gap) return std::nullopt;
    double delay = frames_.front().delay;
    for (std::size_t i = 0; i < known(); ++i) delay = std::max(delay, frames_[i].delay);
    return *gap + delay;
  }

  /// The same with the shortest delay of all that came: of the camera, without what a busy machine
  /// adds.
  [[nodiscard]] std::optional<double> usual() const {
    const std::optional<double> gap = longest_gap();
    return gap ? std::optional(*gap + quickest_) : std::nullopt;
  }

  /// Intervals: a longer gap has lost frames. Half way from one to the two of one that is lost.
  static constexpr double kLost = 1.5;

 private:
  // Clocks of camera and host drift apart, s per s: crystals differ by less (judgement).
  static constexpr double kDrift = 2e-4;

  [[nodiscard]] std::size_t known() const { return std::min(count_, kFrames); }

  // Between two frames, none of which is lost, s. A late frame shortens the gap behind it by as
  // much, so a gap may be as far above their mean as the shortest is below it.
  [[nodiscard]] std::optional<double> longest_gap() const {
    const std::optional<double> interval = this->interval();
    if (!interval) return std::nullopt;
    double shortest = *interval, longest = *interval;
    double sum = 0, whole = 0;
    for (std::size_t i = 0; i < known(); ++i) {
      if (frames_[i].gap > kLost * *interval) continue;
      shortest = std::min(shortest, frames_[i].gap);
      longest = std::max(longest, frames_[i].gap);
      sum += frames_[i].gap;
      whole += 1;
    }
    return std::clamp(2 * sum / whole - shortest, longest, kLost * *interval);
  }

  struct Frame {
    double gap = 0;    // s
    double delay = 0;  // s
  };

  // The longest and the shortest of 16 gaps are worth as much as the longest of 32. Where each
  // stamp is off by a tenth of the interval at most, a frame is later for 0.125 / 32^1.5 = 0.07 %
  // of the time (derived).
  static constexpr std::size_t kFrames = 16;

  std::array<Frame, kFrames> frames_;
  std::size_t count_ = 0;                                      // of all that came
  double quickest_ = std::numeric_limits<double>::infinity();  // delay, s
};

}  // namespace palpate
