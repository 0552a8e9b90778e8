#pragma once

#include <optional>

#include "contact/probe.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate {

/// How the constrained motion of one step is done.
struct SlideOptions {
  ProxyOptions::Method method = ProxyOptions::Method::converged;
  int max_iterations = 20;
  double tangent_tolerance = 1e-3;  ///< of R
  double longest_step = 0;          ///< m; 0: no limit but that of R
  FrictionLaw friction;
  bool moved = false;  ///< the surface has moved since the last step
};

/// Where the constrained motion ended.
struct Slide {
  enum class End {
    resting,      ///< on the surface, as near to the hand as friction lets it
    unfinished,   ///< on the surface; iterations or evaluations ran out
    released,     ///< in free space, at the hand
    interrupted,  ///< in free space, on the path to the hand: the sweep was truncated
    postponed,    ///< on the surface; sweeps before had left too little to see whether it is free,
                  ///< or the path leads behind a surface that has just moved
  };
  End end = End::resting;
  SurfacePoint at;
  bool sliding = false;
  bool leapt = false;                   ///< it went from one face to another through free space
  Standing standing = Standing::front;  ///< of where it left the surface to
  int iterations = 0;
  double dissipated = 0;  ///< by friction, J
};

/// Moves the proxy from `start` on the surface to the position nearest the hand
/// (docs/method.md 3.3): sub-steps in the tangent plane, each brought back to the surface and
/// accepted only if it comes nearer to the hand and the normal does not turn over; leaves the
/// surface when the path to the hand is free.
[[nodiscard]] Slide slide(Probe& probe, const SurfacePoint& start, const Eigen::Vector3d& hip,
                          bool sliding, const SlideOptions& options) noexcept;

/// Has the surface moved over the proxy, or away from under it (docs/method.md 3.4)? `here`: the
/// sample at the proxy; `normal`: of its last contact, zero if none; `changed`: the field's
/// revision is another than in the last step.
[[nodiscard]] bool surface_moved(const Probe& probe, const Sample& here,
                                 const Eigen::Vector3d& normal, bool changed) noexcept;

/// Does a surface that was found face another side than the one that was touched, by 60 degrees and
/// more? `side`: of that; zero: nothing was touched.
[[nodiscard]] bool is_turned(const SurfacePoint& found, const Eigen::Vector3d& side) noexcept;

/// Is a position that Newton found the one that the proxy touched, on a surface that has moved a
/// little (R / 4), or does it need a look from above?
[[nodiscard]] bool is_same_contact(const SurfacePoint& found, const Eigen::Vector3d& position,
                                   const Eigen::Vector3d& normal) noexcept;

/// Looks for the surface from above, along the last normal, within the field's re-anchor reach (at
/// least half of `radius`, R there, m). Empty when there is none that faces the same side, or the
/// sweeps' budget ended the look (`cut`).
[[nodiscard]] std::optional<SurfacePoint> reanchor(Probe& probe, const Eigen::Vector3d& position,
                                                   const Eigen::Vector3d& normal, double radius,
                                                   bool& cut) noexcept;

/// Looks for the surface after Newton has failed: from the first free position along the last
/// normal, up to 2 R away. `looked`: positions that have been looked at; a search that the sweeps'
/// budget ends, after one position at least, goes on there in the next step. One that has come to
/// its end leaves 0.
[[nodiscard]] std::optional<SurfacePoint> recover(Probe& probe, const Eigen::Vector3d& position,
                                                  const Eigen::Vector3d& normal,
                                                  int& looked) noexcept;

}  // namespace palpate
