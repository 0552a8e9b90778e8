#pragma once

#include "palpate/servo/z_width.hpp"

namespace palpate {

/// Result of a device's flight into the wall.
struct Impact {
  double rebound = 0;  ///< speed out over speed in; 0: it stayed within the wall for 2 s
  double energy = 0;   ///< that the forces gave to the device in all, J; below zero: took
};

/// A free flight into the wall and out again.
/// @throws Error when an option is out of its range.
[[nodiscard]] Impact impact(const WallOptions& wall);

/// Does something go to and fro faster than a hand does by itself? The swing between two turning
/// points that lie less than 100 ms apart (5 Hz). Real-time.
class OscillationDetector {
 public:
  static constexpr double kSlowest = 0.1;    ///< s from one turning point to the next (judgement)
  static constexpr double kSmallest = 5e-5;  ///< m of return that count as a turn (judgement)

  /// A position (m), `dt` seconds after the one before. Returns the swing now, m; 0: no
  /// oscillation.
  double add(double position, double dt) noexcept;

 private:
  double turned_at_ = 0;   // position of the last turning point, m
  double farthest_ = 0;    // since then, m
  double since_turn_ = 0;  // from that turning point to the farthest position, s
  double since_farthest_ = 0;
  double swing_ = 0;
  int direction_ = 0;
  bool started_ = false;
};

}  // namespace palpate
