#pragma once

#include "scene/policies/moment.hpp"

namespace palpate {

/// The times of a source's snapshots: a snapshot lasts as long as frames are apart on average, so
/// that the next one finds it just arrived.
class Rhythm {
 public:
  /// The moment of a frame with this stamp whose surface is to start at `start`, s.
  [[nodiscard]] Moment next(double stamp, double start);

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
