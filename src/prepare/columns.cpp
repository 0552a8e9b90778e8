#include "prepare/columns.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
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

namespace {

constexpr float kTrusted = 0.5f;  // confidence

}  // namespace

std::vector<std::uint32_t> first_of_each_place(const CellGrid& grid) {
  std::vector<std::uint8_t> later(grid.size());  // 1: another one stands there before it
  for (const CellGrid::Cell& cell : grid.cells()) {
    if (cell.children > 0) continue;
    const auto points = grid.points().subspan(cell.begin, cell.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto before = points.first(k);
      const bool repeated = std::ranges::find(before, points[k]) != before.end();
      later[grid.order()[cell.begin + k]] = repeated ? 1 : 0;
    }
  }
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < later.size(); ++i) {
    if (later[i] == 0) first.push_back(i);
  }
  return first;
}

std::vector<float> materials_of(const CellGrid& grid, const std::vector<float>& intensities) {
  auto materials = in_grid_order(grid, intensities);
  const auto [low, high] = std::minmax_element(materials.begin(), materials.end());
  const float from = *low;
  const float range = *high - *low;
  for (float& m : materials) m = range > 0 ? (m - from) / range : 1.0f;
  return materials;
}

void tell_trust(const SurfacePoints& points, Prepared::Report& report) {
  std::vector<float> felt;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.density_weights[i] > 0) felt.push_back(points.confidences[i]);
  }
  if (felt.empty()) return;
  const auto tenth = felt.begin() + static_cast<std::ptrdiff_t>(felt.size() / 10);
  std::nth_element(felt.begin(), tenth, felt.end());
  report.trust_low = *tenth;
  const auto doubted = std::ranges::count_if(felt, [](float c) { return c < kTrusted; });
  report.untrusted = static_cast<double>(doubted) / static_cast<double>(felt.size());
}

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

void add_twins(std::span<const Twin> twins, SurfacePoints& points) {
  if (twins.empty()) return;
  SurfacePoints::Sheets& sheets = points.sheets;
  for (const Twin& twin : twins) points.density_weights[twin.point] *= 0.5f;
  std::vector<Eigen::Vector3f> positions(points.grid.points().begin(), points.grid.points().end());
  const auto append = [&](auto& column, std::uint32_t Twin::*from) {
    if (column.empty()) return;
    for (const Twin& twin : twins) column.push_back(column[twin.*from]);
  };
  append(positions, &Twin::point);
  points.grid = CellGrid(positions);

  // All of a twin is the point's but what its host knows of the sheet.
  const auto add = [&](auto& column, std::uint32_t Twin::*from) {
    append(column, from);
    if (!column.empty()) column = in_grid_order(points.grid, column);
  };
  add(points.density_weights, &Twin::point);
  add(points.radii, &Twin::point);
  add(points.confidences, &Twin::point);
  add(points.materials, &Twin::point);
  add(points.colors, &Twin::point);
  add(points.normals, &Twin::host);
  add(sheets.sheet, &Twin::host);
  add(sheets.residual, &Twin::host);
  add(sheets.above, &Twin::host);
  add(sheets.below, &Twin::host);
}

}  // namespace palpate
