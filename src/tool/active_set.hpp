// The motion closest to a wanted one that linear constraints allow: an exact quadratic program.
#pragma once

#include <array>
#include <span>

#include "tool/motion.hpp"

namespace palpate {

/// Allows the motions y with normal . y >= bound.
struct Constraint {
  Motion normal = Motion::Zero();
  double bound = 0;  ///< m
  int sample = -1;   ///< that it keeps out of the surface; -1: none
};

/// A constraint that holds with equality and pushes.
struct ActiveConstraint {
  int index = -1;         ///< of the constraint
  double multiplier = 0;  ///< what it pushes by along its normal, m; at least 0
};

/// Closest allowed motion, and what keeps it from being the wanted one.
struct LeastMotion {
  /// How the search ended.
  enum class End {
    solved,
    infeasible,  ///< the constraints contradict each other; the motion serves nothing
    cut_off,     ///< out of iterations: as much of the motion as no constraint forbids
  };

  End end = End::solved;
  Motion motion = Motion::Zero();
  std::array<ActiveConstraint, kFreedoms> active{};
  int count = 0;  ///< of the active ones
  int iterations = 0;
};

/// Iterations of the solver: each of 8000 random problems of 512 constraints took fewer
/// (tests/tool/active_set_test.cpp, at an effort of 80).
inline constexpr int kSolverIterations = 60;

/// Minimises |y - wanted|^2 over what all constraints allow up to `tolerance` (m): Gauss's least
/// motion (docs/method.md 3.7). The dual active set method of Goldfarb and Idnani (1983) with the
/// identity as Hessian. Exact up to rounding; its active constraints are linearly independent, so
/// there are at most seven. Takes `iterations` at most; allocates nothing.
[[nodiscard]] LeastMotion least_motion(std::span<const Constraint> constraints,
                                       const Motion& wanted, double tolerance,
                                       int iterations = kSolverIterations) noexcept;

}  // namespace palpate
