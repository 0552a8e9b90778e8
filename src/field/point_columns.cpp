// Copies gathered points into columns, run by run, and moves them along with their layers.

#include "field/point_columns.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace palpate {
namespace {

constexpr std::size_t kCacheLine = 64 / sizeof(double);  // doubles in 64 bytes, as most CPUs have

// Doubles (derived): each run is filled up to whole lanes; the selection counts one run a source.
constexpr std::size_t kFilling = simd::kMaxRuns * simd::kLanes;

enum Column {
  kPosition = 0,
  kNormal = 3,
  kWeight = 6,
  kConfidence,
  kRadius,
  kInverseR2,
  kEdgeNormal,
  kEdgeHeight = kEdgeNormal + 3,
  kEdgeShare,
  kSlope,
  kMaterial,
  kPresence,
  kVelocity,
  kColumns = kVelocity + 3
};

/// Does any of the chosen points lie beside an edge?
bool any_edges(const GatheredPoints& points) noexcept {
  for (std::size_t k = 0; points.options.normals && k < points.layers.size(); ++k) {
    const auto beside = [&](std::uint32_t i) { return has_edge(points.layers[k], i); };
    const Selection& chosen = points.selection;
    if (std::ranges::any_of(chosen.indices(chosen.runs()[k]), beside)) return true;
  }
  return false;
}

}  // namespace

PointColumns::PointColumns(std::size_t capacity)
    : pitch_(capacity + kFilling + 2 * kCacheLine),
      data_(kColumns * pitch_, 0.0),
      near_(pitch_ / simd::kLanes + 1) {
  slots_.reserve(capacity);
  for (int axis = 0; axis < 3; ++axis) {
    columns_.position[axis] = column(kPosition + axis);
    columns_.normal[axis] = column(kNormal + axis);
    columns_.edge_normal[axis] = column(kEdgeNormal + axis);
    columns_.velocity[axis] = column(kVelocity + axis);
  }
  columns_.weight = column(kWeight);
  columns_.confidence = column(kConfidence);
  columns_.radius = column(kRadius);
  columns_.inverse_r2 = column(kInverseR2);
  columns_.edge_height = column(kEdgeHeight);
  columns_.edge_share = column(kEdgeShare);
  columns_.slope = column(kSlope);
  columns_.near = near_.data();
}

void PointColumns::write(const GatheredPoints& points) noexcept {
  const auto if_any = [&](int c, const auto& has) {
    return std::ranges::any_of(points.layers, has) ? column(c) : nullptr;
  };
  const auto varies = [](const ActiveLayer& of) { return !of.points->materials.empty(); };
  columns_.material = if_any(kMaterial, varies);
  columns_.presence = if_any(kPresence, [](const ActiveLayer& of) { return fades(*of.points); });
  columns_.edges = any_edges(points);
  sort(points);
}

void PointColumns::sort(const GatheredPoints& points) noexcept {
  lay_out(points);
  columns_.moves = std::ranges::any_of(points.layers, moves);
  for (std::size_t k = 0; k < points.layers.size(); ++k) fill_layer(points, k);
  measure(points.ball.radius);
}

/// Layers that fade and do not change otherwise get new weights alone.
void PointColumns::advance(GatheredPoints& points, std::span<const ActiveLayer> layers) noexcept {
  const bool moved = std::ranges::any_of(layers, moves);
  const bool all = std::exchange(columns_.moves, moved) != moved;
  bool filled = false;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const ActiveLayer& now = layers[k];
    const ActiveLayer before = std::exchange(points.layers[k], now);
    const bool later = now.progress != before.progress || now.rate != before.rate;
    if (all || (later && has_end(*now.points))) {
      fill_layer(points, k);
      filled = true;
    } else if (now.weight != before.weight) {
      fill_weights(points, k);
    }
  }
  if (filled) measure(points.ball.radius);
}

/// Gives every point its slot in the columns.
void PointColumns::lay_out(const GatheredPoints& points) noexcept {
  std::array<std::uint32_t, simd::kMaxRuns> next{};
  const int sources = points.sources;
  const auto run_of = [&](std::size_t layer, std::size_t k) {
    return static_cast<std::size_t>(points.labels[k] * sources + points.layers[layer].source);
  };
  const auto each = [&](const auto& visit) {
    std::size_t k = 0;
    for (std::size_t layer = 0; layer < points.layers.size(); ++layer) {
      for (std::uint32_t n = points.selection.runs()[layer].count; n-- > 0; ++k) visit(layer, k);
    }
  };
  each([&](std::size_t layer, std::size_t k) { ++next[run_of(layer, k)]; });
  columns_.sources = sources;
  columns_.labels = 1;
  columns_.run_begin[0] = 0;
  for (int run = 0; run < simd::kLabels * sources; ++run) {
    std::uint32_t& slot = next[static_cast<std::size_t>(run)];
    if (slot > 0) columns_.labels = run / sources + 1;
    const std::uint32_t begin = columns_.run_begin[run];
    const std::uint32_t end = begin + slot;
    const std::uint32_t filled = (end + simd::kLanes - 1) / simd::kLanes * simd::kLanes;
    pad(end, filled);
    columns_.run_begin[run + 1] = filled;
    slot = begin;
  }
  slots_.resize(points.signs.size());
  each([&](std::size_t layer, std::size_t k) { slots_[k] = next[run_of(layer, k)]++; });
}

/// Fills up with points that weigh nothing.
void PointColumns::pad(std::uint32_t begin, std::uint32_t end) noexcept {
  for (int c = 0; begin < end && c < kColumns; ++c) {
    std::fill(column(c) + begin, column(c) + end, 0.0);
  }
}

/// Visits a layer's points: index in the layer, slot in the columns, sign.
void PointColumns::each_of(const GatheredPoints& points, std::size_t k,
                           const auto& visit) noexcept {
  const Selection::Run& run = points.selection.runs()[k];
  std::size_t chosen = run.first;
  for (const std::uint32_t i : points.selection.indices(run)) {
    visit(i, slots_[chosen], points.signs[chosen]);
    ++chosen;
  }
}

void PointColumns::fill_layer(const GatheredPoints& points, std::size_t k) noexcept {
  const ActiveLayer& layer = points.layers[k];
  const std::vector<float>& materials = layer.points->materials;
  const double common = points.options.radius;
  each_of(points, k, [&](std::uint32_t i, std::uint32_t at, std::int8_t) {
    const Eigen::Vector3d position = position_now(layer, i, points.ball.center);
    for (int axis = 0; axis < 3; ++axis) column(kPosition + axis)[at] = position[axis];
    const double radius = common > 0 ? common : radius_now(layer, i);
    column(kRadius)[at] = radius;
    column(kInverseR2)[at] = 1 / (radius * radius);
    if (columns_.material) column(kMaterial)[at] = materials.empty() ? 1.0 : materials[i];
    if (columns_.presence) column(kPresence)[at] = presence_now(layer, i);
    if (!columns_.moves) return;
    const Eigen::Vector3d velocity = velocity_now(layer, i);
    for (int axis = 0; axis < 3; ++axis) column(kVelocity + axis)[at] = velocity[axis];
  });
  fill_weights(points, k);
  if (points.options.normals) fill_normals(points, k);
}

void PointColumns::fill_weights(const GatheredPoints& points, std::size_t k) noexcept {
  const bool raw = points.options.raw_weights;
  each_of(points, k, [&](std::uint32_t i, std::uint32_t at, std::int8_t sign) {
    column(kWeight)[at] =
        sign == 0 ? 0 : weight_now(points.layers[k], i, raw) * points.selection.stride();
  });
}

void PointColumns::fill_normals(const GatheredPoints& points, std::size_t k) noexcept {
  const ActiveLayer& layer = points.layers[k];
  const bool has_normals = !layer.points->normals.empty();
  each_of(points, k, [&](std::uint32_t i, std::uint32_t at, std::int8_t sign) {
    const Eigen::Vector3d normal = sign * normal_now(layer, i);
    for (int axis = 0; axis < 3; ++axis) column(kNormal + axis)[at] = normal[axis];
    column(kConfidence)[at] = has_normals ? confidence_now(layer, i) : 0.0;
    if (!columns_.edges) return;
    const SurfacePoints::EdgePlane edge = edge_now(layer, i);
    for (int axis = 0; axis < 3; ++axis) {
      column(kEdgeNormal + axis)[at] = sign * static_cast<double>(edge.normal[axis]);
    }
    column(kEdgeHeight)[at] = sign * static_cast<double>(edge.height);
    column(kEdgeShare)[at] = sign * static_cast<double>(edge.share);
  });
}

/// Computes the mean, the smallest and the common radius (0: radii differ).
void PointColumns::measure(double reach) noexcept {
  double sum = 0;
  double largest = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t slot : slots_) {
    const double radius = columns_.radius[slot];
    sum += radius;
    largest = std::max(largest, radius);
    smallest = std::min(smallest, radius);
  }
  columns_.smallest_radius = smallest;
  columns_.uniform_radius = smallest == largest ? largest : 0;
  columns_.mean_radius = slots_.empty() ? reach : sum / static_cast<double>(slots_.size());
}

double PatchColumns::nearest_radius(const Eigen::Vector3d& x) const noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  double result = 0;
  for (std::uint32_t i = 0; i < end(); ++i) {
    const Eigen::Vector3d p(position[0][i], position[1][i], position[2][i]);
    const double squared = (p - x).squaredNorm();
    if (radius[i] <= 0 || squared >= nearest) continue;  // padding has no radius
    nearest = squared;
    result = radius[i];
  }
  return result;
}

}  // namespace palpate
