// Reads points of a moving layer, and walks the index for those that reach into a ball.

#include "field/selection.hpp"

#include <algorithm>
#include <utility>

#include "field/simd/sums.hpp"

namespace palpate {
namespace {

double lerp(double a, double b, double u) noexcept {
  return a + u * (b - a);
}

double own_radius(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.radii[i];
  return points.end_radii.empty() ? start : lerp(start, points.end_radii[i], layer.progress);
}

/// C_k, less where the point was widened.
double layer_weight(const ActiveLayer& layer, std::uint32_t i) noexcept {
  if (!(layer.least_radius > 0)) return layer.weight;
  const double share = std::min(1.0, own_radius(layer, i) / layer.least_radius);
  return share * share * layer.weight;
}

}  // namespace

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

Eigen::Vector3d velocity_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  if (points.end_positions.empty()) return Eigen::Vector3d::Zero();
  return layer.rate * (points.end_positions[i] - points.grid.points()[i]).cast<double>();
}

double weight_now(const ActiveLayer& layer, std::uint32_t i, bool raw_weights) noexcept {
  const double weight = layer_weight(layer, i);
  if (raw_weights) return weight;
  const SurfacePoints& points = *layer.points;
  const double start = points.density_weights[i];
  if (points.end_density_weights.empty()) return weight * start;
  return weight * lerp(start, points.end_density_weights[i], layer.progress);
}

double radius_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  return std::max(own_radius(layer, i), layer.least_radius);
}

double confidence_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.confidences[i];
  return points.end_confidences.empty() ? start
                                        : lerp(start, points.end_confidences[i], layer.progress);
}

SurfacePoints::EdgePlane edge_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  if (!has_edge(layer, i)) return {};
  const SurfacePoints::Edges& edges = layer.points->edges;
  const SurfacePoints::EdgePlane& start = edges.start[edges.of_point[i]];
  if (edges.end.empty()) return start;
  const SurfacePoints::EdgePlane& end = edges.end[edges.of_point[i]];
  const auto u = static_cast<float>(layer.progress);
  return {start.normal + u * (end.normal - start.normal),
          start.height + u * (end.height - start.height),
          start.share + u * (end.share - start.share)};
}

double presence_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.presences.empty() ? 1.0 : points.presences[i];
  if (points.end_presences.empty()) return start;
  return lerp(start, points.end_presences[i], layer.progress);
}

bool has_end(const SurfacePoints& points) noexcept {
  return !(points.end_positions.empty() && points.end_normals.empty() &&
           points.end_density_weights.empty() && points.end_radii.empty() &&
           points.end_confidences.empty() && points.end_presences.empty() &&
           points.edges.end.empty());
}

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kLargestStride = std::uint32_t{1}
                                         << 31;  // the largest power of 2 in 32 bits

/// From the origin to the segment from a to b.
double squared_distance(const Vector3d& a, const Vector3d& b) noexcept {
  const Vector3d path = b - a;
  const double length = path.squaredNorm();
  if (!(length > 0)) return a.squaredNorm();
  return (a + std::clamp(-a.dot(path) / length, 0.0, 1.0) * path).squaredNorm();
}

}  // namespace

Selection::Selection(std::size_t capacity) : indices_(capacity, 0), indices_before_(capacity, 0) {
  runs_.reserve(kMostLayers);
  runs_before_.reserve(kMostLayers);
}

void Selection::begin() noexcept {
  runs_.clear();
  used_ = 0;
  stride_ = 1;
  visits_ = 0;
}

bool Selection::choose(std::span<const ActiveLayer> layers, const Ball& ball,
                       const SelectOptions& options) noexcept {
  ball_ = ball;
  options_ = options;
  begin();
  return choose_all(layers, {});
}

bool Selection::renew(std::span<const ActiveLayer> layers, std::span<const std::size_t> before,
                      int most_visits) noexcept {
  options_.most_visits = most_visits;
  const bool whole = stride_ == 1;  // thinned runs lack points that there may be room for now
  std::swap(indices_, indices_before_);
  std::swap(runs_, runs_before_);
  begin();
  return choose_all(layers, whole ? before : std::span<const std::size_t>());
}

bool Selection::choose_all(std::span<const ActiveLayer> layers,
                           std::span<const std::size_t> before) noexcept {
  bool chosen = layers.size() <= kMostLayers;
  for (std::size_t k = 0; chosen && k < layers.size(); ++k) {
    const ActiveLayer& layer = layers[k];
    const bool counts = layer.weight > 0 || (layer.until > layer.progress && layer.last_weight > 0);
    runs_.push_back({layer.progress, std::max(layer.progress, layer.until), counts, used_, 0});
    if (!before.empty() && before[k] != kNone) {
      chosen = take_over(runs_before_[before[k]]);
    } else if (counts) {
      chosen = walk(layer);
    }
    runs_.back().count = used_ - runs_.back().first;
  }
  while (chosen && filled_up(layers) > indices_.size()) {
    chosen = stride_ < kLargestStride;
    if (chosen) thin();
  }
  if (!chosen) runs_.clear();
  return chosen;
}

bool Selection::take_over(const Run& run) noexcept {
  Run& now = runs_.back();
  now.from = run.from;
  now.until = run.until;
  now.counts = run.counts;
  return std::ranges::all_of(std::span(indices_before_).subspan(run.first, run.count),
                             [this](std::uint32_t index) { return take(index); });
}

bool Selection::walk(const ActiveLayer& layer) noexcept {
  const SurfacePoints& points = *layer.points;
  ActiveLayer last = layer;
  last.progress = runs_.back().until;
  const CellTest test(ball_.center - points.origin);
  CellStack stack(points);
  while (!stack.empty()) {
    if (visits_ >= options_.most_visits) return false;
    ++visits_;
    const std::uint32_t index = stack.pop();
    const CellGrid::Cell& cell = points.grid.cells()[index];
    const double reach = std::max<double>(points.cell_reach[index], options_.radius);
    if (!test.near(cell, reach + layer.least_radius + ball_.radius)) continue;
    if (cell.children > 0 && cell.size() > stride_) {
      stack.push_children(cell);
    } else if (!take_near(layer, last, cell.begin, cell.end)) {
      return false;
    }
  }
  return true;
}

/// Takes the points of a run that reach into the ball, every stride_-th of them.
bool Selection::take_near(const ActiveLayer& start, const ActiveLayer& last, std::uint32_t begin,
                          std::uint32_t end) noexcept {
  const SurfacePoints& points = *start.points;
  const PointTest test(points, ball_.center - points.origin);
  const auto extra = static_cast<float>(ball_.radius);
  const auto radius = static_cast<float>(options_.radius);
  std::uint64_t i = (std::uint64_t{begin} + stride_ - 1) / stride_ * stride_;
  while (i < end) {
    if (visits_ >= options_.most_visits) return false;
    ++visits_;
    const auto index = static_cast<std::uint32_t>(i);
    const float own = radius > 0 ? radius : largest_radius(start, index);
    if (!test.far(index, own + extra) && reaches(start, last, index) &&
        counts(start, last, index)) {
      if (!take(index)) return false;
    }
    i = (i / stride_ + 1) * stride_;  // the stride may have grown
  }
  return true;
}

bool Selection::reaches(const ActiveLayer& start, const ActiveLayer& last,
                        std::uint32_t i) const noexcept {
  const Vector3d a = position_now(start, i, ball_.center);
  const bool moves = last.progress > start.progress;
  const double own =
      moves ? std::max(radius_now(start, i), radius_now(last, i)) : radius_now(start, i);
  const double reach = (options_.radius > 0 ? options_.radius : own) + ball_.radius;
  if (a.squaredNorm() <= reach * reach) return true;
  if (!moves || start.points->end_positions.empty()) return false;
  return squared_distance(a, position_now(last, i, ball_.center)) <= reach * reach;
}

bool Selection::counts(const ActiveLayer& start, const ActiveLayer& last,
                       std::uint32_t i) const noexcept {
  const SurfacePoints& points = *start.points;
  if (options_.raw_weights || points.end_density_weights.empty()) return !weightless(points, i);
  const auto weight_at = [&](double u) {
    const double a = points.density_weights[i];
    return a + u * (points.end_density_weights[i] - a);
  };
  return weight_at(start.progress) > 0 || weight_at(last.progress) > 0;
}

/// False when there is no room for it, however few are taken.
bool Selection::take(std::uint32_t index) noexcept {
  while (used_ == indices_.size()) {
    if (stride_ == kLargestStride) return false;
    thin();
  }
  if (index % stride_ == 0) indices_[used_++] = index;
  return true;
}

void Selection::thin() noexcept {
  stride_ *= 2;
  runs_.back().count = used_ - runs_.back().first;
  std::uint32_t kept = 0;
  for (Run& run : runs_) {
    const std::uint32_t end = run.first + run.count;
    const std::uint32_t first = kept;
    for (std::uint32_t k = run.first; k < end; ++k) {
      if (indices_[k] % stride_ == 0) indices_[kept++] = indices_[k];
    }
    run.first = first;
    run.count = kept - first;
  }
  used_ = kept;
}

/// The number of indices when every source's are filled up.
std::size_t Selection::filled_up(std::span<const ActiveLayer> layers) const noexcept {
  std::size_t total = 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (k > 0 && layers[k].source != layers[k - 1].source) {
      total = (total + simd::kLanes - 1) / simd::kLanes * simd::kLanes;
    }
    total += runs_[k].count;
  }
  return (total + simd::kLanes - 1) / simd::kLanes * simd::kLanes;
}

}  // namespace palpate
