#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate {

/// Where something was at one time. The frame is said by whoever hands it over.
struct TrajectoryRow {
  double time = 0;                                     ///< s
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
};

/// A path in time: times grow strictly from row to row, evenly or not.
using Trajectory = std::vector<TrajectoryRow>;

}  // namespace palpate
