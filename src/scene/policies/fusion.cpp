#include "scene/policies/fusion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "prepare/weights.hpp"

namespace palpate {
namespace {

constexpr double kNoWeight = 1e-9;

}  // namespace

void LayerHistory::add(std::shared_ptr<const SurfacePoints> newest, const FrameTiming& moment,
                       std::vector<Snapshot::Layer>& layers) {
  age(moment);
  layers_.push_back({std::move(newest), 0, 0});
  const auto most =
      policy_ == Policy::crossfade ? Snapshot::kMaxLayers : static_cast<std::size_t>(history_);
  if (layers_.size() > most) drop();
  weigh();
  last_ = moment;
  layers.assign(layers_.begin(), layers_.end());
}

/// Weights as they are at the new start; what has faded away is dropped.
void LayerHistory::age(const FrameTiming& moment) {
  const double u = progress(last_, moment.start);
  for (Snapshot::Layer& layer : layers_) {
    layer.weight_start += u * (layer.weight_end - layer.weight_start);
  }
  std::erase_if(layers_, [](const Snapshot::Layer& layer) {
    return layer.weight_start <= kNoWeight && layer.weight_end <= kNoWeight;
  });
}

/// Makes room: takes out what matters least. Clouds that come at three times their rate do that to
/// a crossfade of four.
void LayerHistory::drop() {
  const auto least = policy_ == Policy::crossfade
                         ? std::min_element(layers_.begin(), layers_.end() - 1,
                                            [](const Snapshot::Layer& a, const Snapshot::Layer& b) {
                                              return a.weight_start < b.weight_start;
                                            })
                         : layers_.begin();
  layers_.erase(least);
}

void LayerHistory::weigh() {
  const std::size_t counted = std::min(layers_.size(), static_cast<std::size_t>(history_));
  const double share = 1 / static_cast<double>(counted);
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const bool counts = layers_.size() - k <= counted;
    layers_[k].weight_end = counts ? share : 0;
    if (policy_ != Policy::crossfade) layers_[k].weight_start = layers_[k].weight_end;
  }
  const double sum = std::accumulate(
      layers_.begin(), layers_.end(), 0.0,
      [](double total, const Snapshot::Layer& layer) { return total + layer.weight_start; });
  if (sum <= 0) layers_.back().weight_start = 1;
  // One had to go early, or the sum is off by rounding.
  for (Snapshot::Layer& layer : layers_) layer.weight_start /= sum > 0 ? sum : 1;
}

namespace {

constexpr int kMemory = 8;           // clouds
constexpr double kParts = 16;        // of a point, to count running means of counts by
constexpr double kMostLeaves = 1e9;  // farther off, voxels have no number
constexpr double kFaded = 0.02;      // a voxel that counts less is gone
constexpr double kLeafSpacings = 2;  // leaf of a cloud that preparation would keep whole
// A first cloud of few points has told little: one with so many times more tells again and, where
// that is so many times finer, all begins with it. Four times as many on a surface lie half as far
// apart.
constexpr std::size_t kMore = 4;
constexpr double kFiner = 2;

struct Sum {
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  int count = 0;
};

}  // namespace

void Fusion::add(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor, bool one_view) {
  const PointCloud clipped = prepare_.clip ? clip(cloud, *prepare_.clip) : cloud;
  if (leaf_ == 0 || cloud.size() > kMore * told_by_) choose_leaf(cloud, T_world_sensor);
  const std::vector<Eigen::Vector3d> points = usable(clipped, T_world_sensor);
  if (points.empty() && voxels_.empty()) throw Error("the cloud has no usable points");
  mix(points);
  PrepareOptions options = prepare_;
  options.voxel = 0;
  options.clip.reset();
  options.material_from_intensity = false;  // means have none
  options.viewpoint = T_world_sensor * prepare_.viewpoint.value_or(
                                           cloud.viewpoint.value_or(Eigen::Vector3d::Zero()));
  if (!eye_) eye_ = options.viewpoint;
  one_eye_ = one_eye_ && (*options.viewpoint - *eye_).norm() <= leaf_;
  one_view_ = one_view;
  prepared_ = prepare(means(), options);
}

SurfacePoints Fusion::surface(const FrameTiming& moment) {
  age(moment);
  last_ = moment;
  show();
  return place(prepared_.points);
}

/// In the world, relative to origin_.
std::vector<Eigen::Vector3d> Fusion::usable(const PointCloud& cloud,
                                            const Eigen::Isometry3d& T_world_sensor) const {
  const double farthest = kMostLeaves * leaf_;
  std::vector<Eigen::Vector3d> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = T_world_sensor * cloud.point(i) - origin_;
    if (p.cwiseAbs().maxCoeff() < farthest && p.allFinite()) points.push_back(p);
  }
  return points;
}

void Fusion::choose_leaf(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor) {
  const Prepared::Report report = prepare(cloud, prepare_, T_world_sensor).report;
  const double leaf = report.voxel > 0 ? report.voxel : kLeafSpacings * report.spacing;
  told_by_ = cloud.size();
  if (leaf_ > 0 && leaf > leaf_ / kFiner) return;
  voxels_.clear();
  leaf_ = leaf;
  origin_ = T_world_sensor * cloud.origin;
}

/// Brings what is shown to the new start.
void Fusion::age(const FrameTiming& moment) {
  const auto u = static_cast<float>(progress(last_, moment.start));
  const auto between = [u](const auto& a, const auto& b) { return a + u * (b - a); };
  for (auto& [key, voxel] : voxels_) {
    Shown& start = voxel.start;
    const Shown& end = voxel.end;
    start.position = between(start.position, end.position);
    start.normal = between(start.normal, end.normal).normalized();
    start.weight = between(start.weight, end.weight);
    start.radius = between(start.radius, end.radius);
    start.confidence = between(start.confidence, end.confidence);
  }
}

/// What nobody has filled for long has faded away with the last snapshot, and is dropped.
void Fusion::mix(const std::vector<Eigen::Vector3d>& points) {
  std::map<Key, Sum> sums;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3i cell = (p / leaf_).array().floor().cast<int>();
    Sum& sum = sums[{cell.x(), cell.y(), cell.z()}];
    sum.total += p;
    ++sum.count;
  }
  for (auto& [key, voxel] : voxels_) {
    if (!sums.contains(key)) voxel.occupancy *= 1 - 1.0 / kMemory;
  }
  for (const auto& [key, sum] : sums) {
    Voxel& voxel = voxels_[key];
    voxel.clouds = std::min(voxel.clouds + 1, kMemory);
    const double share = 1.0 / voxel.clouds;
    voxel.sum += share * (sum.total - voxel.sum);
    voxel.count += share * (sum.count - voxel.count);
    voxel.occupancy += share * (1 - voxel.occupancy);
  }
  std::erase_if(voxels_, [](const auto& entry) {
    return entry.second.occupancy < kFaded && entry.second.end.weight <= 0;
  });
}

PointCloud Fusion::means() const {
  PointCloud cloud;
  cloud.origin = origin_;
  cloud.positions.reserve(voxels_.size());
  for (const auto& [key, voxel] : voxels_) cloud.positions.push_back(voxel.mean().cast<float>());
  return cloud;
}

/// What preparation makes of the means is where the voxels' points go. Points that stand for many
/// weigh more: a voxel that the surface only touches holds few, which lie off it. Points at one
/// place, such as the two of a crease, are one: what is shown has one sheet only.
void Fusion::show() {
  const SurfacePoints& ends = prepared_.points;
  std::vector<std::uint32_t> counts(ends.size());
  std::vector<float> weights(ends.size());
  std::vector<std::uint32_t> places;  // of the voxels' points among the ends
  std::vector<std::uint32_t> same;
  for (const auto& [key, voxel] : voxels_) {
    same.clear();
    ends.grid.within(voxel.mean().cast<float>(), 0, same);
    places.push_back(same.front());
    for (const std::uint32_t k : same) {
      counts[k] = static_cast<std::uint32_t>(std::lround(kParts * voxel.count));
      weights[places.back()] += ends.density_weights[k];
    }
  }
  weigh_by_counts(ends.grid, counts, ends.radii, weights);
  auto place = places.begin();
  for (auto& [key, voxel] : voxels_) {
    const std::uint32_t k = *place++;
    const bool gone = voxel.occupancy < kFaded;
    voxel.end = {ends.grid.points()[k], ends.normals[k],
                 gone ? 0 : weights[k] * static_cast<float>(voxel.occupancy), ends.radii[k],
                 ends.confidences[k]};
    if (voxel.start.radius > 0 && voxel.start.normal.dot(voxel.end.normal) >= 0) continue;
    const float weight = voxel.start.radius > 0 ? voxel.start.weight : 0;
    voxel.start = voxel.end;
    voxel.start.weight = weight;
  }
}

/// Indexes the points where they come from.
SurfacePoints Fusion::place(const SurfacePoints& ends) const {
  std::vector<const Voxel*> voxels;
  std::vector<Eigen::Vector3f> starts;
  for (const auto& [key, voxel] : voxels_) {
    voxels.push_back(&voxel);
    starts.push_back(voxel.start.position);
  }
  SurfacePoints points;
  points.origin = ends.origin;
  points.kernel = ends.kernel;
  points.one_sided = one_eye_ && one_view_;
  points.grid = CellGrid(starts);
  for (const std::uint32_t i : points.grid.order()) {
    const Shown& start = voxels[i]->start;
    const Shown& end = voxels[i]->end;
    points.normals.push_back(start.normal);
    points.density_weights.push_back(start.weight);
    points.radii.push_back(start.radius);
    points.confidences.push_back(start.confidence);
    points.end_positions.push_back(end.position);
    points.end_normals.push_back(end.normal);
    points.end_density_weights.push_back(end.weight);
    points.end_radii.push_back(end.radius);
    points.end_confidences.push_back(end.confidence);
  }
  finish(points);
  return points;
}

}  // namespace palpate
