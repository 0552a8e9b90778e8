#pragma once

#include "streams/stream_run.hpp"

namespace palpate::streams {

/// Over the scored ticks of a set-up.
struct Measures {
  double jump = 0;       ///< force change over the 4 ticks after a swap beyond what the hand's
                         ///< motion explains, RMS, N
  double jump_high = 0;  ///< its 95th percentile, N
  double vibration = 0;  ///< force from 20 to 400 Hz, RMS, N
  double ripple = 0;     ///< force above 20 Hz, RMS, N
  double force = 0;      ///< |F - F_ideal|, RMS, N; where the ideal is known
  double normal = 0;     ///< angle between force and ideal force, RMS, degrees; likewise
  /// Deviation over time of the field's normal in one tangential direction, degrees.
  double normal_sd = 0;
  /// How far the proxy is behind (under) the true surface, mean, mm. Where that moves, less what
  /// the latency explains and less what it is at rest.
  double lag = 0;
  double lag_sd = 0;   ///< mm
  double contact = 0;  ///< share of ticks with at least 20 % of the ideal force
  double step = 0;     ///< largest change of force from one tick to the next, N
  double pops = 0;     ///< times that contact was lost for three ticks or more
  double radius = 0;   ///< R at the proxy, mean, mm
};

/// Against the ideal proxy on what stands still: `ideal` is its trace; null where the surface
/// moves, where the ideal force is K times the hand's depth.
[[nodiscard]] Measures measure(const Setup& setup, const StreamTrace& trace,
                               const accuracy::Trace* ideal);

}  // namespace palpate::streams
