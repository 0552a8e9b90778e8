#pragma once

#include "contact/friction.hpp"
#include "contact/newton.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate {

/// How the constrained motion of one step is done.
struct SlideOptions {
  ProxyMethod method = ProxyMethod::converged;
  int max_iterations = 20;
  double tangent_tolerance = 1e-3;  ///< of R
  double longest_step = 0;          ///< m; 0: no limit but that of R
  FrictionLaw friction;
};

/// Where the constrained motion ended.
struct Slide {
  enum class End {
    resting,      ///< on the surface, as near to the hand as friction lets it
    unfinished,   ///< on the surface; iterations or evaluations ran out
    released,     ///< in free space, at the hand
    interrupted,  ///< in free space, on the way to the hand: the sweep was truncated
    postponed,    ///< on the surface; sweeps before had left too little to see whether it is free
  };
  End end = End::resting;
  SurfacePoint at;
  bool sliding = false;
  int iterations = 0;
  double dissipated = 0;  ///< by friction, J
};

/// Moves the proxy from `start` on the surface to the place nearest to the hand (algorithm.md 2.3):
/// sub-steps in the tangent plane, each brought back to the surface and accepted only if it comes
/// nearer to the hand and the normal does not turn over; leaves the surface when the way to the
/// hand is free.
[[nodiscard]] Slide slide(Probe& probe, const SurfacePoint& start, const Eigen::Vector3d& hip,
                          bool sliding, const SlideOptions& options) noexcept;

}  // namespace palpate
