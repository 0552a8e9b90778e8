// The facts of a cloud, such as spacing and noise: one for all of it, however little is prepared.
#pragma once

#include <Eigen/Geometry>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

struct PrepareOptions;

/// The noise of raw points.
struct Noise {
  double sigma = 0;  ///< rms distance from a smooth surface, of the flattest quarter, m
  /// Factor from sigma_n delta of narrow windows to what averaging has to cope with, as neighbours
  /// err together; 1: they do not.
  double excess = 1;
  double shared = 1;  ///< the same factor for sigma alone
};

/// What preparation measures of a whole cloud. Where it is given, preparing a part of the cloud
/// finds what preparing the whole finds there: all else depends on what lies around a point. Up is
/// +z, always.
struct CloudFacts {
  double spacing = 0;     ///< s of the points as given, the median, m
  Noise noise = {};       ///< of the points as given
  bool in_lines = false;  ///< do they lie on lines, nearer to each other than the lines are?
  Box extent = {};        ///< of all but a few outliers, world frame, m
  double radius = 0;      ///< a typical R, m; 0: not measured, and R has no cap
};

/// Measures the facts of a cloud at positions that are drawn, the same ones of the same cloud: some
/// thousand points around each, which takes a few tenths of a second whatever the cloud's size.
/// A few outliers change nothing, and crops of one scan have nearly the same facts.
/// @throws Error as prepare() does.
[[nodiscard]] CloudFacts measure_facts(
    const PointCloud& cloud, const PrepareOptions& options,
    const Eigen::Isometry3d& T_world_sensor = Eigen::Isometry3d::Identity());

/// The same of a store, of which some hundred nodes are read. A box to clip by does not count.
/// @throws Error as prepare() and PointStore::read() do.
[[nodiscard]] CloudFacts measure_facts(
    const PointStore& store, const PrepareOptions& options,
    const Eigen::Isometry3d& T_world_sensor = Eigen::Isometry3d::Identity());

}  // namespace palpate
