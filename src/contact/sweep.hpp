#pragma once

#include "contact/probe.hpp"

namespace palpate {

/// Of all sweeps in one step, in Probe::work().
inline constexpr int kSweepWork = 1000 * kEvaluationWork;

/// Where the way from one place to another ends.
struct Sweep {
  enum class End {
    clear,      ///< free all the way
    hit,        ///< something solid: `position` is the last free place before it
    truncated,  ///< the step's budget ran out: free as far as `position`
  };
  End end = End::clear;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
};

/// One ball around the whole way: true if it is certainly free.
[[nodiscard]] bool way_is_free(Probe& probe, const Eigen::Vector3d& from,
                               const Eigen::Vector3d& to) noexcept;

/// First contact on the way (docs/method.md 3.1): bisection into balls that are free for certain
/// and leaves shorter than the field's resolution, whose ends are sampled. No solid chord longer
/// than the resolution is missed. `from` is taken to be free.
[[nodiscard]] Sweep sweep(Probe& probe, const Eigen::Vector3d& from,
                          const Eigen::Vector3d& to) noexcept;

/// way_is_free(), and sweep() if it is not.
[[nodiscard]] Sweep first_contact(Probe& probe, const Eigen::Vector3d& from,
                                  const Eigen::Vector3d& to) noexcept;

}  // namespace palpate
