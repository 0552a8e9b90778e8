#include "field/patch.hpp"

#include <algorithm>
#include <limits>

#include "field/traversal.hpp"

namespace palpate {
namespace {

constexpr std::size_t kCacheLine = 64 / sizeof(double);

double lerp(double a, double b, double u) noexcept {
  return a + u * (b - a);
}

Eigen::Vector3d normal_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  if (points.normals.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d start = points.normals[i].cast<double>();
  if (points.end_normals.empty()) return start;
  const Eigen::Vector3d mixed =
      start + layer.progress * (points.end_normals[i].cast<double>() - start);
  const double length = mixed.norm();
  return length > 1e-6 ? Eigen::Vector3d(mixed / length) : start;
}

double presence_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.presences.empty() ? 1.0 : points.presences[i];
  if (points.end_presences.empty()) return start;
  return lerp(start, points.end_presences[i], layer.progress);
}

double confidence_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.confidences[i];
  return points.end_confidences.empty() ? start
                                        : lerp(start, points.end_confidences[i], layer.progress);
}

Eigen::Vector3d velocity_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  if (points.end_positions.empty()) return Eigen::Vector3d::Zero();
  return layer.rate * (points.end_positions[i] - points.grid.points()[i]).cast<double>();
}

}  // namespace

Eigen::Vector3d position_now(const ActiveLayer& layer, std::uint32_t i,
                             const Eigen::Vector3d& center) noexcept {
  const SurfacePoints& points = *layer.points;
  Eigen::Vector3d position = points.grid.points()[i].cast<double>();
  if (!points.end_positions.empty()) {
    position += layer.progress * (points.end_positions[i].cast<double>() - position);
  }
  return position - (center - points.origin);
}

double weight_now(const ActiveLayer& layer, std::uint32_t i, bool raw_weights) noexcept {
  if (raw_weights) return layer.weight;
  const SurfacePoints& points = *layer.points;
  const double start = points.density_weights[i];
  if (points.end_density_weights.empty()) return layer.weight * start;
  return layer.weight * lerp(start, points.end_density_weights[i], layer.progress);
}

double radius_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.radii[i];
  return points.end_radii.empty() ? start : lerp(start, points.end_radii[i], layer.progress);
}

bool weightless(const SurfacePoints& points, std::uint32_t i) noexcept {
  return points.density_weights[i] <= 0 &&
         (points.end_density_weights.empty() || points.end_density_weights[i] <= 0);
}

Patch::Patch(std::size_t capacity)
    : capacity_((capacity + simd::kLanes - 1) / simd::kLanes * simd::kLanes),
      pitch_(capacity_ + 2 * kCacheLine),
      data_(kColumns * pitch_, 0.0),
      index_(capacity_, 0),
      near_(capacity_ / simd::kLanes, 0) {
  for (int axis = 0; axis < 3; ++axis) {
    columns_.position[axis] = column(kPosition + axis);
    columns_.normal[axis] = column(kNormal + axis);
  }
  columns_.weight = column(kWeight);
  columns_.confidence = column(kConfidence);
  columns_.radius = column(kRadius);
  columns_.inverse_r2 = column(kInverseR2);
  columns_.sharp = column(kSharp);
  columns_.slope = column(kSlope);
  columns_.trusted = column(kTrusted);
  columns_.near = near_.data();
  for (int k = 0; k < 2; ++k) columns_.closeness[k] = column(kCloseness + k);
}

void Patch::gather(std::span<const ActiveLayer> layers, int sources, const Eigen::Vector3d& center,
                   double extra, const GatherOptions& options) noexcept {
  center_ = center;
  extra_ = extra;
  options_ = options;
  has_sharp_ = std::ranges::any_of(
      layers, [](const ActiveLayer& layer) { return layer.points->sharp_edges; });
  has_materials_ = std::ranges::any_of(
      layers, [](const ActiveLayer& layer) { return !layer.points->materials.empty(); });
  has_presences_ =
      std::ranges::any_of(layers, [](const ActiveLayer& layer) { return fades(*layer.points); });
  has_motion_ =
      std::ranges::any_of(layers, [](const ActiveLayer& layer) { return layer.rate > 0; });
  stride_ = 1;
  while (!gather_all(layers, sources)) stride_ *= 2;
  columns_.uniform_radius = smallest_radius_ == largest_radius_ ? largest_radius_ : 0;
  mean_radius_ = count_ > 0 ? radius_sum_ / static_cast<double>(count_) : extra;
}

bool Patch::gather_all(std::span<const ActiveLayer> layers, int sources) noexcept {
  used_ = 0;
  count_ = 0;
  smallest_radius_ = std::numeric_limits<double>::infinity();
  largest_radius_ = 0;
  radius_sum_ = 0;
  columns_.uniform_sharp = 0;
  columns_.sources = sources;
  columns_.source_begin[0] = 0;
  std::size_t next = 0;
  for (int source = 0; source < sources; ++source) {
    for (; next < layers.size() && layers[next].source == source; ++next) {
      if (layers[next].weight > 0 && !gather_layer(layers[next])) return false;
    }
    pad();
    columns_.source_begin[source + 1] = used_;
  }
  return true;
}

bool Patch::gather_layer(const ActiveLayer& layer) noexcept {
  const std::uint32_t first = used_;
  const CellTest test(center_ - layer.points->origin);
  CellStack stack(*layer.points);
  while (!stack.empty()) {
    const std::uint32_t index = stack.pop();
    const CellGrid::Cell& cell = layer.points->grid.cells()[index];
    const double reach = std::max<double>(layer.points->cell_reach[index], options_.radius);
    if (!test.near(cell, reach + extra_)) continue;
    if (cell.children > 0 && cell.end - cell.begin > stride_) {
      stack.push_children(cell);
    } else if (!take_near(layer, cell.begin, cell.end)) {
      return false;
    }
  }
  fill(layer, first);
  return true;
}

/// Notes the places of a run's points that are near enough, every stride_-th of them.
bool Patch::take_near(const ActiveLayer& layer, std::uint32_t begin, std::uint32_t end) noexcept {
  const SurfacePoints& points = *layer.points;
  const Eigen::Vector3f* const start = points.grid.points().data();
  const Eigen::Vector3f* const way =
      points.end_positions.empty() ? nullptr : points.end_positions.data();
  const Eigen::Vector3d shift = center_ - points.origin;
  const std::uint32_t first = (begin + stride_ - 1) / stride_ * stride_;
  for (std::uint64_t i = first; i < end; i += stride_) {
    const auto k = static_cast<std::uint32_t>(i);
    const Eigen::Vector3d position =
        way ? position_now(layer, k, center_) : Eigen::Vector3d(start[k].cast<double>() - shift);
    const double reach = (options_.radius > 0 ? options_.radius : radius_now(layer, k)) + extra_;
    if (position.squaredNorm() > reach * reach || weightless(points, k)) continue;
    if (used_ == capacity_) return false;
    for (int axis = 0; axis < 3; ++axis) column(kPosition + axis)[used_] = position[axis];
    index_[used_++] = k;
  }
  return true;
}

/// Copies what the surface needs of the points noted since `first`, column by column.
void Patch::fill(const ActiveLayer& layer, std::uint32_t first) noexcept {
  const SurfacePoints& points = *layer.points;
  for (std::uint32_t k = first; k < used_; ++k) {
    const double radius = options_.radius > 0 ? options_.radius : radius_now(layer, index_[k]);
    column(kRadius)[k] = radius;
    column(kInverseR2)[k] = inverse_square(radius);
    column(kWeight)[k] = weight_now(layer, index_[k], options_.raw_weights) * stride_;
    smallest_radius_ = std::min(smallest_radius_, radius);
    largest_radius_ = std::max(largest_radius_, radius);
    radius_sum_ += radius;
  }
  if (has_sharp_ && first < used_) fill_sharpness(layer, first);
  count_ += used_ - first;
  if (options_.normals) fill_normals(layer, first);
  for (std::uint32_t k = first; has_materials_ && k < used_; ++k) {
    column(kMaterial)[k] = points.materials.empty() ? 1.0 : points.materials[index_[k]];
  }
  for (std::uint32_t k = first; has_presences_ && k < used_; ++k) {
    column(kPresence)[k] = presence_now(layer, index_[k]);
  }
  for (std::uint32_t k = first; has_motion_ && k < used_; ++k) {
    const Eigen::Vector3d velocity = velocity_now(layer, index_[k]);
    for (int axis = 0; axis < 3; ++axis) column(kVelocity + axis)[k] = velocity[axis];
  }
}

void Patch::fill_normals(const ActiveLayer& layer, std::uint32_t first) noexcept {
  const SurfacePoints& points = *layer.points;
  for (std::uint32_t k = first; k < used_; ++k) {
    const Eigen::Vector3d normal = normal_now(layer, index_[k]);
    for (int axis = 0; axis < 3; ++axis) column(kNormal + axis)[k] = normal[axis];
    column(kConfidence)[k] = points.normals.empty() ? 0.0 : confidence_now(layer, index_[k]);
  }
}

void Patch::fill_sharpness(const ActiveLayer& layer, std::uint32_t first) noexcept {
  const double sharp = layer.points->sharp_edges ? 1 : 0;
  std::fill(column(kSharp) + first, column(kSharp) + used_, sharp);
  const bool alike = count_ == 0 || columns_.uniform_sharp == sharp;
  columns_.uniform_sharp = alike ? sharp : -1;
}

/// Neighbours mostly share their radius, and a division is what a gather would spend most time on.
double Patch::inverse_square(double radius) noexcept {
  if (radius != last_radius_) {
    last_radius_ = radius;
    last_inverse_r2_ = 1 / (radius * radius);
  }
  return last_inverse_r2_;
}

void Patch::pad() noexcept {
  while (used_ % simd::kLanes != 0) {  // the capacity is a multiple of kLanes
    for (int c = 0; c < kColumns; ++c) column(c)[used_] = 0;
    ++used_;
  }
}

double Patch::nearest_radius(const Eigen::Vector3d& x) const noexcept {
  const Eigen::Vector3d local = x - center_;
  double nearest = std::numeric_limits<double>::infinity();
  double radius = 0;
  for (std::uint32_t i = 0; i < used_; ++i) {
    const Eigen::Vector3d p(column(0)[i], column(1)[i], column(2)[i]);
    const double squared = (p - local).squaredNorm();
    if (columns_.radius[i] <= 0 || squared >= nearest) continue;  // padding has no radius
    nearest = squared;
    radius = columns_.radius[i];
  }
  return radius;
}

}  // namespace palpate
