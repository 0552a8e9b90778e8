#include "prepare/check_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "palpate/base/error.hpp"
#include "prepare/given_normals.hpp"

namespace palpate {
namespace {

constexpr double kRigid = 1e-4;  // of R^T R from the identity: float's digits and then some

/// Either empty or one for each point.
void require_column(const char* name, std::size_t length, std::size_t points) {
  if (length == 0 || length == points) return;
  throw Error(fmt::format("the cloud has {} {} for {} points: give one for each, or none", length,
                          name, points));
}

void check(const PointCloud& cloud) {
  require_column("normals", cloud.normals.size(), cloud.size());
  require_column("colors", cloud.colors.size(), cloud.size());
  require_column("intensities", cloud.intensities.size(), cloud.size());
  if (!cloud.origin.allFinite()) {
    throw Error("the cloud's origin is not finite: give a place in metres");
  }
  if (cloud.viewpoint && !cloud.viewpoint->allFinite()) {
    throw Error("the cloud's viewpoint is not finite: give a place in metres, or none");
  }
}

void check_intensities(const std::vector<float>& intensities) {
  if (intensities.empty()) {
    throw Error("materials are to come from intensities, but the cloud has none");
  }
  const auto odd = std::ranges::find_if_not(intensities, [](float v) { return std::isfinite(v); });
  if (odd == intensities.end()) return;
  throw Error(
      fmt::format("materials are to come from intensities, but that of point {} is {}: repair or "
                  "drop the point",
                  odd - intensities.begin(), *odd));
}

}  // namespace

void check_pose(const Eigen::Isometry3d& pose) {
  if (!pose.matrix().allFinite()) throw Error("the pose is not finite: give a rotation and metres");
  const Eigen::Matrix3d turn = pose.linear();
  const double off = (turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm();
  if (off < kRigid && turn.determinant() > 0) return;
  throw Error(fmt::format(
      "the pose scales, shears or mirrors (its rotation is off by {:.3g}): give a rigid "
      "one and scale the cloud by itself",
      off));
}

void check(const PrepareOptions& options, const PointCloud& cloud) {
  check(cloud);
  const Requirement require{"preparation"};
  if (options.voxel) {
    require.not_negative("voxel", *options.voxel,
                         "give 0 (keep every point) or a length in metres");
  }
  if (options.radius) {
    require.positive("radius", *options.radius, "give a length above 0, in metres");
  }
  if (options.radius_multiple) {
    require.positive("radius_multiple", *options.radius_multiple,
                     "give a number above 0 (2.5 unless there is a reason)");
  }
  require.not_negative("minimum_radius", options.minimum_radius, "give 0 or a length in metres");
  require.positive("normal_error", options.normal_error, "give an angle above 0, in radians");
  if (options.orientation == Orientation::viewpoint && !options.viewpoint && !cloud.viewpoint) {
    throw Error("normals are to point to the viewpoint, but none is known; give one");
  }
  if (options.orientation == Orientation::given && share_given(cloud.normals) == 0) {
    throw Error("normals are to be as given, but the cloud has none");
  }
  if (options.viewpoint && !options.viewpoint->allFinite()) {
    throw Error("preparation option viewpoint is not finite: give a place in metres");
  }
  if (options.material_from_intensity) check_intensities(cloud.intensities);
}

}  // namespace palpate
