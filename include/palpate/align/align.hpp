#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "palpate/field/surface_points.hpp"

namespace palpate {

/// A surface that is to be aligned with others.
struct RoughSource {
  std::string name;                             ///< for messages
  std::shared_ptr<const SurfacePoints> points;  ///< where it roughly stands
};

/// Aligned pose of one source, and its uncertainty.
struct AlignedSource {
  /// Fit of one surface to the others.
  struct Fit {
    double residual = 0;  ///< median distance along the normals where both are there, m
    double overlap = 0;   ///< share of its points that lie on another surface, 0-1
  };

  Eigen::Isometry3d T_aligned_rough = Eigen::Isometry3d::Identity();  ///< both in the world frame
  Fit before;
  Fit after;
  /// Standard deviations of position (m, in the worst direction, in the middle of the overlap) and
  /// of rotation (rad, about the worst axis); 0: the first source.
  double position_deviation = 0;
  double turn_deviation = 0;
};

/// Moves all but the first so that the surfaces lie on one another where they overlap. Sources that
/// are off by some 10 cm and 10 degrees are found back. Point-to-plane ICP (Chen and Medioni 1992),
/// each source first against those before it from several starts, then all at once. The deviations
/// follow from what the fit leaves at positions far apart. Not real-time; any thread; the
/// same input gives the same answer.
/// @throws Error naming the source that has no normals or too few points, that shares too little
/// with those before it, or that what it shares leaves free to slide or turn; of less than two.
[[nodiscard]] std::vector<AlignedSource> align(const std::vector<RoughSource>& sources);

}  // namespace palpate
