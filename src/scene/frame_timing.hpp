#pragma once

#include <algorithm>

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
  constexpr double kArrived = 1 - 1e-6;
  if (!(last.duration > 0)) return 1;
  const double share = std::clamp((time - last.start) / last.duration, 0.0, 1.0);
  return share > kArrived ? 1 : share;
}

/// The times of a source's snapshots: a snapshot lasts as long as frames are apart on average, so
/// that the next one finds it just arrived.
class FrameIntervalFilter {
 public:
  /// The moment of a frame with this stamp whose surface is to start at `start`, s.
  [[nodiscard]] FrameTiming next(double stamp, double start);

  /// Smoothed time between frames, s; a thirtieth until there have been two.
  [[nodiscard]] double interval() const { return interval_; }

 private:
  void measure(double stamp);

  double interval_ = 1. / 30;
  double last_stamp_ = 0;
  double last_start_ = 0;
  int frames_ = 0;
};

}  // namespace palpate
