#include "prepare/check_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/requirement.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

constexpr double kRigid = 1e-4;  // of R^T R from the identity: float's digits and then some

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
  if (off < kRigid && turn.determinant() > 0) return;
  throw Error(
      fmt::format("the pose scales, shears or mirrors (its rotation is off by {:.3g}): give a "
                  "rigid pose and scale the cloud itself",
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
                     "give a number above 0 (usually 2.5)");
  }
  require.not_negative("minimum_radius", options.minimum_radius, "give 0 or a length in metres");
  require.positive("normal_error", options.normal_error, "give an angle above 0, in radians");
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

constexpr std::size_t kNormalSamples = 1000;
constexpr std::size_t kNearbyNormals = 4;
constexpr float kAlikeCosine = 0.94f;  // 20 degrees
constexpr double kFewestGiven = 0.25;  // a smaller share is as good as none

bool is_given(const Eigen::Vector3f& normal) {
  return normal.allFinite() && normal.squaredNorm() > 0;
}

/// How far normals turn from a point to its nearest, whatever their sign: the median of
/// 1 - |cosine|.
double variation(const CellGrid& grid, std::span<const Eigen::Vector3f> normals) {
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kNormalSamples);
  std::vector<float> turns;
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = 0; i < grid.size(); i += step) {
    if (!is_given(normals[i])) continue;
    grid.nearest(grid.points()[i], kNearbyNormals, near);
    for (const auto& [j, squared] : near) {
      if (squared > 0 && is_given(normals[j])) {
        turns.push_back(1 - std::abs(normals[i].normalized().dot(normals[j].normalized())));
      }
    }
  }
  return turns.empty() ? 1 : median(turns);
}

}  // namespace

double share_given(std::span<const Eigen::Vector3f> given) {
  if (given.empty()) return 0;
  return static_cast<double>(std::ranges::count_if(given, is_given)) /
         static_cast<double>(given.size());
}

void take_given_normals(const CellGrid& grid, std::span<const Eigen::Vector3f> given,
                        std::span<Eigen::Vector3f> normals) {
  if (share_given(given) < kFewestGiven) return;
  if (variation(grid, given) > variation(grid, normals)) return;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (!is_given(given[i])) continue;
    const Eigen::Vector3f unit = given[i].normalized();
    const float cosine = unit.dot(normals[i]);
    if (std::abs(cosine) >= kAlikeCosine) normals[i] = cosine < 0 ? Eigen::Vector3f(-unit) : unit;
  }
}

}  // namespace palpate
