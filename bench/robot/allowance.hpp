#pragma once

#include <Eigen/Core>

#include "robot/trial.hpp"

/// How deep a target may be: what no camera can have told in time.
namespace palpate::robot {

/// How deep a place is in solids of the truth at time t (s), mm; the ball of the tool counts.
[[nodiscard]] double depth_at(const Trial& trial, const Eigen::Vector3d& x, double t);

/// Is a place in the middle of a camera's picture at time t (s), and nothing stands before it?
[[nodiscard]] bool is_seen(const Trial& trial, const Watcher& watcher, const Eigen::Vector3d& x,
                           double t);

struct Allowance {
  double mm = 0;      ///< a target may be so deep
  double noise = 0;   ///< of it for noise, mm
  double window = 0;  ///< the rest is what the surface moved in so long, s
};

/// Noise and one frame's motion at a place, for a target that is told at time t (s).
[[nodiscard]] Allowance allowance(const Trial& trial, const Eigen::Vector3d& x, double t);

}  // namespace palpate::robot
