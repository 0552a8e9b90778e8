// Checks a cloud and its options, cuts it and moves it into the world frame.

#include "prepare/place.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "palpate/base/error.hpp"
#include "prepare/description.hpp"
#include "prepare/given_normals.hpp"

namespace palpate {
namespace {

// R^T R off the identity, at most: a pose in floats passes, a scale of 1.001 does not; judgement.
constexpr double kRigid = 1e-4;

/// Either empty or one for each point.
void require_column(const char* name, std::size_t length, std::size_t points) {
  if (length == 0 || length == points) return;
  throw Error(fmt::format("the cloud has {} {} for {} points: give one per point, or none", length,
                          name, points));
}

void check(const PointCloud& cloud) {
  require_column("normals", cloud.normals.size(), cloud.size());
  require_column("colors", cloud.colors.size(), cloud.size());
  require_column("intensities", cloud.intensities.size(), cloud.size());
  if (!cloud.origin.allFinite()) {
    throw Error("the cloud's origin is not finite: give a position in metres");
  }
  if (cloud.viewpoint && !cloud.viewpoint->allFinite()) {
    throw Error("the cloud's viewpoint is not finite: give a position in metres, or none");
  }
}

void check_intensities(const std::vector<float>& intensities) {
  if (intensities.empty()) {
    throw Error("materials from intensities were requested, but the cloud has no intensities");
  }
  const auto odd = std::ranges::find_if_not(intensities, [](float v) { return std::isfinite(v); });
  if (odd == intensities.end()) return;
  throw Error(
      fmt::format("materials from intensities were requested, but the intensity of point {} is {}: "
                  "correct or drop the point",
                  odd - intensities.begin(), *odd));
}

}  // namespace

void check_pose(const Eigen::Isometry3d& pose) {
  if (!pose.matrix().allFinite())
    throw Error("the pose is not finite: give a finite rotation and translation");
  const Eigen::Matrix3d turn = pose.linear();
  const double off = (turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm();
  const bool mirrors = turn.determinant() < 0;
  if (off < kRigid && mirrors) throw Error("the pose mirrors: reverse one of its axes");
  if (off < kRigid) return;
  throw Error(
      fmt::format("the pose scales or shears (its rotation is off by {:.3g}): give a "
                  "rigid pose and scale the cloud itself",
                  off));
}

void check(const PrepareOptions& options, const PointCloud& cloud) {
  check(cloud);
  check_described("preparation", options);
  if (options.facts) {
    const Requirement require{"preparation"};
    require.not_negative("facts.noise.sigma", options.facts->noise.sigma, "give metres, 0 or more");
  }
  if (options.orientation == PrepareOptions::Orientation::viewpoint && !options.viewpoint &&
      !cloud.viewpoint) {
    throw Error("orienting normals to the viewpoint needs one; give a viewpoint");
  }
  if (options.orientation == PrepareOptions::Orientation::given &&
      share_given(cloud.normals) == 0) {
    throw Error(
        "keeping the given normals was requested, but the cloud has none; choose another "
        "orientation");
  }
  if (options.viewpoint && !options.viewpoint->allFinite()) {
    throw Error("preparation option viewpoint is not finite: give a position in metres");
  }
  if (options.material_from_intensity) check_intensities(cloud.intensities);
}

namespace {

PointCloud placed(PointCloud cloud, const Eigen::Isometry3d& T_world_sensor) {
  const Eigen::Matrix3f turn = T_world_sensor.linear().cast<float>();
  cloud.origin = T_world_sensor * cloud.origin;
  if (!turn.isIdentity(0)) {
    for (auto& p : cloud.positions) p = turn * p;
    for (auto& n : cloud.normals) n = turn * n;
  }
  if (cloud.viewpoint) cloud.viewpoint = T_world_sensor * *cloud.viewpoint;
  return cloud;
}

}  // namespace

Placed place(const PointCloud& cloud, const PrepareOptions& options,
             const Eigen::Isometry3d& T_world_sensor) {
  check(options, cloud);
  check_pose(T_world_sensor);
  Placed result{cloud, {}, {}};
  if (options.clip || !T_world_sensor.matrix().isIdentity(0)) {
    result.moved = placed(options.clip ? clip(cloud, *options.clip) : cloud, T_world_sensor);
  }
  result.viewpoint =
      options.viewpoint ? T_world_sensor * *options.viewpoint : result.cloud().viewpoint;
  if (!result.cloud().empty()) return result;
  throw Error(
      fmt::format("none of the {} points is left: check the clip box and the file", cloud.size()));
}

}  // namespace palpate
