#include "scene/policies/fusion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palpate/geometry/filters.hpp"

namespace palpate {
namespace {

constexpr int kMemory = 8;       // clouds
constexpr double kFaded = 0.02;  // a voxel that counts less is gone
constexpr double kSpacings = 2;  // leaf of a cloud that preparation would keep whole

struct Sum {
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  int count = 0;
};

}  // namespace

SurfacePoints Fusion::add(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor,
                          const Moment& moment, PrepareReport& report) {
  if (leaf_ == 0) choose_leaf(cloud, T_world_sensor);
  age(moment);
  mix(prepare_.clip ? clip(cloud, *prepare_.clip) : cloud, T_world_sensor);
  last_ = moment;
  PrepareOptions options = prepare_;
  options.voxel = 0;
  options.clip.reset();
  options.viewpoint = T_world_sensor * prepare_.viewpoint.value_or(
                                           cloud.viewpoint.value_or(Eigen::Vector3d::Zero()));
  const Prepared prepared = prepare(means(), options);
  report = prepared.report;
  return place(prepared);
}

void Fusion::choose_leaf(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor) {
  const PrepareReport report = prepare(cloud, prepare_, T_world_sensor).report;
  leaf_ = report.voxel > 0 ? report.voxel : kSpacings * report.spacing;
  origin_ = T_world_sensor * cloud.origin;
}

/// Brings everything to the new start.
void Fusion::age(const Moment& moment) {
  const double u = progress(last_, moment.start);
  for (auto& [key, voxel] : voxels_) {
    voxel.start += u * (voxel.end - voxel.start);
    voxel.weight_start += u * (voxel.weight_end - voxel.weight_start);
    voxel.weight_end *= 1 - 1.0 / kMemory;  // unless it is filled again
    if (voxel.weight_end < kFaded) voxel.weight_end = 0;
  }
  std::erase_if(voxels_, [](const auto& entry) {
    return entry.second.weight_start <= 0 && entry.second.weight_end <= 0;
  });
}

void Fusion::mix(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor) {
  std::map<Key, Sum> sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = T_world_sensor * cloud.point(i) - origin_;
    const Eigen::Vector3i cell = (p / leaf_).array().floor().cast<int>();
    Sum& sum = sums[{cell.x(), cell.y(), cell.z()}];
    sum.total += p;
    ++sum.count;
  }
  for (const auto& [key, sum] : sums) {
    const Eigen::Vector3d mean = sum.total / sum.count;
    Voxel& voxel = voxels_[key];
    if (voxel.clouds == 0) voxel.start = voxel.end = mean;
    voxel.clouds = std::min(voxel.clouds + 1, kMemory);
    const double share = 1.0 / voxel.clouds;
    voxel.end += share * (mean - voxel.end);
    // What age() took away comes back, and a share of what is missing.
    const double before = voxel.weight_end / (1 - 1.0 / kMemory);
    voxel.weight_end = std::min(1.0, before + share * (1 - before));
  }
}

PointCloud Fusion::means() const {
  PointCloud cloud;
  cloud.origin = origin_;
  cloud.positions.reserve(voxels_.size());
  for (const auto& [key, voxel] : voxels_) cloud.positions.push_back(voxel.end.cast<float>());
  return cloud;
}

/// Preparation knows the points where they go to; they are indexed where they come from.
SurfacePoints Fusion::place(const Prepared& prepared) {
  const SurfacePoints& ends = prepared.points;
  std::vector<std::uint32_t> sorted(ends.size());  // of each voxel, its place in `ends`
  for (std::uint32_t k = 0; k < sorted.size(); ++k) sorted[ends.grid.order()[k]] = k;
  std::vector<Voxel*> voxels;
  std::vector<Eigen::Vector3f> starts;
  for (auto& [key, voxel] : voxels_) {
    voxels.push_back(&voxel);
    starts.push_back(voxel.start.cast<float>());
  }
  SurfacePoints points;
  points.origin = ends.origin;
  points.kernel = ends.kernel;
  points.grid = CellGrid(starts);
  for (const std::uint32_t i : points.grid.order()) {
    Voxel& voxel = *voxels[i];
    const std::uint32_t k = sorted[i];
    const bool known = voxel.normal.dot(ends.normals[k]) > 0;
    points.normals.push_back(known ? voxel.normal : ends.normals[k]);
    points.end_normals.push_back(ends.normals[k]);
    points.end_positions.push_back(ends.grid.points()[k]);
    points.radii.push_back(ends.radii[k]);
    points.confidences.push_back(ends.confidences[k]);
    const auto weight = ends.density_weights[k];
    points.density_weights.push_back(weight * static_cast<float>(voxel.weight_start));
    points.end_density_weights.push_back(weight * static_cast<float>(voxel.weight_end));
    voxel.normal = ends.normals[k];
  }
  finish(points);
  return points;
}

}  // namespace palpate
