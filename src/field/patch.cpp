// Copies the selected points into columns and moves them along with their layers.

#include "field/patch.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace palpate {
namespace {

constexpr std::size_t kCacheLine = 64 / sizeof(double);  // doubles in 64 bytes, as most CPUs have

// Doubles (derived): each run is filled up to whole lanes; the selection counts one run a source.
constexpr std::size_t kFilling = simd::kMaxRuns * simd::kLanes;

bool any(std::span<const ActiveLayer> layers, const auto& property) noexcept {
  return std::ranges::any_of(layers, property);
}

}  // namespace

Patch::Patch(std::size_t capacity)
    : capacity_((capacity + simd::kLanes - 1) / simd::kLanes * simd::kLanes),
      pitch_(capacity_ + kFilling + 2 * kCacheLine),
      data_(kColumns * pitch_, 0.0),
      selection_(capacity_),
      facing_(capacity_),
      near_(pitch_ / simd::kLanes + 1) {
  layers_.reserve(kMostLayers);
  signs_.reserve(capacity_);
  labels_.reserve(capacity_);
  slots_.reserve(capacity_);
  for (int axis = 0; axis < 3; ++axis) {
    columns_.position[axis] = column(kPosition + axis);
    columns_.normal[axis] = column(kNormal + axis);
    columns_.edge_normal[axis] = column(kEdgeNormal + axis);
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

bool Patch::gather(std::span<const ActiveLayer> layers, int sources, const Eigen::Vector3d& center,
                   double extra, const GatherOptions& options) noexcept {
  center_ = center;
  extra_ = extra;
  options_ = options;
  const bool whole = selection_.choose(layers, {center, extra},
                                       {.radius = options.radius,
                                        .raw_weights = options.raw_weights,
                                        .most_visits = options.most_visits});
  copy(layers, sources, whole);
  return whole;
}

bool Patch::advance(std::span<const ActiveLayer> layers) noexcept {
  if (extra_ < 0 || outdated_) return false;
  outdated_ = layers.size() != layers_.size();
  for (std::size_t k = 0; !outdated_ && k < layers.size(); ++k) outdated_ = !follows(layers[k], k);
  if (outdated_) return false;
  fill(layers);
  return true;
}

bool Patch::renew(std::span<const ActiveLayer> layers, int sources, int most_visits,
                  const Stance* stance) noexcept {
  options_.stance = stance;
  std::array<std::size_t, kMostLayers> before{};
  std::transform(layers.begin(), layers.begin() + std::min(layers.size(), kMostLayers),
                 before.begin(), [this](const ActiveLayer& layer) { return followed_by(layer); });
  const bool whole = selection_.renew(layers, before, most_visits);
  copy(layers, sources, whole);
  return whole;
}

/// Copies what was chosen into the columns.
void Patch::copy(std::span<const ActiveLayer> layers, int sources, bool whole) noexcept {
  if (!whole) {
    extra_ = -1;
    layers = {};
  }
  outdated_ = false;
  layers_.clear();
  sources_ = sources;
  has_materials_ =
      any(layers, [](const ActiveLayer& layer) { return !layer.points->materials.empty(); });
  has_presences_ = any(layers, [](const ActiveLayer& layer) { return fades(*layer.points); });
  count_ = 0;
  for (const Selection::Run& run : selection_.runs()) count_ += run.count;
  signs_.assign(count_, 1);
  labels_.assign(count_, kInFront);
  layers_.assign(layers.begin(), layers.end());  // within what was reserved
  columns_.edges = knows_edges();
  if (options_.stance && whole) turn(*options_.stance);
  options_.stance = nullptr;
  lay_out();
  fill_all();
}

bool Patch::turn(const Stance& stance) noexcept {
  const bool sided = options_.normals ||
                     any(layers_, [](const ActiveLayer& layer) { return layer.points->one_sided; });
  if (!sided && !layers_.empty()) return false;
  return facing_.face({layers_, &selection_, signs_, labels_, options_.rise}, stance);
}

void Patch::face(const Stance& stance) noexcept {
  if (extra_ < 0 || outdated_ || !turn(stance)) return;
  lay_out();
  fill_all();
}

/// Is a layer the k-th that was gathered, on its way?
bool Patch::follows(const ActiveLayer& now, std::size_t k) const noexcept {
  const Selection::Run& run = selection_.runs()[k];
  const bool same = now.points == layers_[k].points && now.source == layers_[k].source &&
                    now.least_radius == layers_[k].least_radius;
  const bool on_the_way =
      !has_end(*now.points) || (now.progress >= run.from && now.progress <= run.until);
  return same && on_the_way && (run.counts || !(now.weight > 0));
}

/// The index of the gathered layer that `now` continues; kNone: there is none.
std::size_t Patch::followed_by(const ActiveLayer& now) const noexcept {
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    if (follows(now, k)) return k;
  }
  return Selection::kNone;
}

/// Gives every point its place in the columns.
void Patch::lay_out() noexcept {
  std::array<std::uint32_t, simd::kMaxRuns> next{};
  const auto run_of = [this](std::size_t layer, std::size_t k) {
    return static_cast<std::size_t>(labels_[k] * sources_ + layers_[layer].source);
  };
  const auto each = [this](const auto& visit) {
    std::size_t k = 0;
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
      for (std::uint32_t n = selection_.runs()[layer].count; n-- > 0; ++k) visit(layer, k);
    }
  };
  each([&](std::size_t layer, std::size_t k) { ++next[run_of(layer, k)]; });
  columns_.sources = sources_;
  columns_.labels = 1;
  columns_.run_begin[0] = 0;
  for (int run = 0; run < simd::kLabels * sources_; ++run) {
    std::uint32_t& place = next[static_cast<std::size_t>(run)];
    if (place > 0) columns_.labels = run / sources_ + 1;
    const std::uint32_t begin = columns_.run_begin[run];
    const std::uint32_t end = begin + place;
    const std::uint32_t filled = (end + simd::kLanes - 1) / simd::kLanes * simd::kLanes;
    pad(end, filled);
    columns_.run_begin[run + 1] = filled;
    place = begin;
  }
  slots_.resize(count_);
  each([&](std::size_t layer, std::size_t k) { slots_[k] = next[run_of(layer, k)]++; });
}

/// Brings all columns to what the layers are now. Layers that fade and do not change otherwise get
/// new weights alone.
void Patch::fill(std::span<const ActiveLayer> layers) noexcept {
  const bool moved = any(layers, moves);
  const bool all = moved != has_motion_;
  has_motion_ = moved;
  bool filled = false;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const ActiveLayer& now = layers[k];
    const ActiveLayer before = std::exchange(layers_[k], now);
    const bool later = now.progress != before.progress || now.rate != before.rate;
    if (all || (later && has_end(*now.points))) {
      fill_layer(k);
      filled = true;
    } else if (now.weight != before.weight) {
      fill_weights(k);
    }
  }
  if (filled) measure();
}

void Patch::fill_all() noexcept {
  has_motion_ = any(layers_, moves);
  for (std::size_t k = 0; k < layers_.size(); ++k) fill_layer(k);
  measure();
}

/// Visits a layer's points: place in the layer, place in the columns, sign.
void Patch::each_of(std::size_t k, const auto& visit) noexcept {
  std::size_t chosen = selection_.runs()[k].first;
  for (const std::uint32_t i : selection_.places(selection_.runs()[k])) {
    visit(i, slots_[chosen], signs_[chosen]);
    ++chosen;
  }
}

void Patch::fill_layer(std::size_t k) noexcept {
  const ActiveLayer& layer = layers_[k];
  const SurfacePoints& points = *layer.points;
  each_of(k, [&](std::uint32_t i, std::uint32_t at, std::int8_t) {
    const Eigen::Vector3d position = position_now(layer, i, center_);
    for (int axis = 0; axis < 3; ++axis) column(kPosition + axis)[at] = position[axis];
    const double radius = options_.radius > 0 ? options_.radius : radius_now(layer, i);
    column(kRadius)[at] = radius;
    column(kInverseR2)[at] = 1 / (radius * radius);
    if (has_materials_)
      column(kMaterial)[at] = points.materials.empty() ? 1.0 : points.materials[i];
    if (has_presences_) column(kPresence)[at] = presence_now(layer, i);
    if (!has_motion_) return;
    const Eigen::Vector3d velocity = velocity_now(layer, i);
    for (int axis = 0; axis < 3; ++axis) column(kVelocity + axis)[at] = velocity[axis];
  });
  fill_weights(k);
  if (options_.normals) fill_normals(k);
  if (columns_.edges) fill_edges(k);
}

void Patch::fill_weights(std::size_t k) noexcept {
  const ActiveLayer& layer = layers_[k];
  each_of(k, [&](std::uint32_t i, std::uint32_t at, std::int8_t sign) {
    column(kWeight)[at] =
        sign == 0 ? 0 : weight_now(layer, i, options_.raw_weights) * selection_.stride();
  });
}

void Patch::fill_normals(std::size_t k) noexcept {
  const ActiveLayer& layer = layers_[k];
  const bool has_normals = !layer.points->normals.empty();
  each_of(k, [&](std::uint32_t i, std::uint32_t at, std::int8_t sign) {
    const Eigen::Vector3d normal = sign * normal_now(layer, i);
    for (int axis = 0; axis < 3; ++axis) column(kNormal + axis)[at] = normal[axis];
    column(kConfidence)[at] = has_normals ? confidence_now(layer, i) : 0.0;
  });
}

void Patch::fill_edges(std::size_t k) noexcept {
  each_of(k, [&](std::uint32_t i, std::uint32_t at, double sign) {
    const SurfacePoints::EdgePlane edge = edge_now(layers_[k], i);
    for (int axis = 0; axis < 3; ++axis) {
      column(kEdgeNormal + axis)[at] = sign * static_cast<double>(edge.normal[axis]);
    }
    column(kEdgeHeight)[at] = sign * static_cast<double>(edge.height);
    column(kEdgeShare)[at] = sign * static_cast<double>(edge.share);
  });
}

/// Does any of the chosen points lie beside an edge?
bool Patch::knows_edges() const noexcept {
  for (std::size_t k = 0; options_.normals && k < layers_.size(); ++k) {
    const auto beside = [&](std::uint32_t i) { return has_edge(layers_[k], i); };
    if (std::ranges::any_of(selection_.places(selection_.runs()[k]), beside)) return true;
  }
  return false;
}

/// Computes the mean, the smallest and the common radius (0: radii differ).
void Patch::measure() noexcept {
  double sum = 0;
  double largest = 0;
  smallest_radius_ = std::numeric_limits<double>::infinity();
  for (const std::uint32_t slot : slots_) {
    const double radius = column(kRadius)[slot];
    sum += radius;
    largest = std::max(largest, radius);
    smallest_radius_ = std::min(smallest_radius_, radius);
  }
  columns_.uniform_radius = smallest_radius_ == largest ? largest : 0;
  mean_radius_ = count_ > 0 ? sum / static_cast<double>(count_) : extra_;
}

/// Fills up with points that weigh nothing.
void Patch::pad(std::uint32_t begin, std::uint32_t end) noexcept {
  for (int c = 0; begin < end && c < kColumns; ++c) {
    std::fill(column(c) + begin, column(c) + end, 0.0);
  }
}

double Patch::nearest_radius(const Eigen::Vector3d& x) const noexcept {
  const Eigen::Vector3d local = x - center_;
  double nearest = std::numeric_limits<double>::infinity();
  double radius = 0;
  for (std::uint32_t i = 0; i < columns_.end(); ++i) {
    const Eigen::Vector3d p(column(0)[i], column(1)[i], column(2)[i]);
    const double squared = (p - local).squaredNorm();
    if (columns_.radius[i] <= 0 || squared >= nearest) continue;  // padding has no radius
    nearest = squared;
    radius = columns_.radius[i];
  }
  return radius;
}

}  // namespace palpate
