#include "field/patch.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace palpate {
namespace {

constexpr std::size_t kCacheLine = 64 / sizeof(double);

bool any(std::span<const ActiveLayer> layers, const auto& property) noexcept {
  return std::ranges::any_of(layers, property);
}

}  // namespace

Patch::Patch(std::size_t capacity)
    : capacity_((capacity + simd::kLanes - 1) / simd::kLanes * simd::kLanes),
      pitch_(capacity_ + 2 * kCacheLine),
      data_(kColumns * pitch_, 0.0),
      selection_(capacity_),
      near_(capacity_ / simd::kLanes, 0) {
  layers_.reserve(kMostLayers);
  begins_.reserve(kMostLayers);
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

bool Patch::renew(std::span<const ActiveLayer> layers, int sources, int most_visits) noexcept {
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
  begins_.clear();
  has_materials_ =
      any(layers, [](const ActiveLayer& layer) { return !layer.points->materials.empty(); });
  has_presences_ = any(layers, [](const ActiveLayer& layer) { return fades(*layer.points); });
  lay_out(layers, sources);
  fill(layers);
}

/// Is a layer the k-th that was gathered, on its way?
bool Patch::follows(const ActiveLayer& now, std::size_t k) const noexcept {
  const Selection::Run& run = selection_.runs()[k];
  const bool same = now.points == layers_[k].points && now.source == layers_[k].source &&
                    now.least_radius == layers_[k].least_radius;
  const bool on_the_way = now.progress >= run.from && now.progress <= run.until;
  return same && on_the_way && (run.counts || !(now.weight > 0));
}

/// Which of the layers that were gathered.
std::size_t Patch::followed_by(const ActiveLayer& now) const noexcept {
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    if (follows(now, k)) return k;
  }
  return Selection::kNone;
}

/// Gives every layer its place in the columns.
void Patch::lay_out(std::span<const ActiveLayer> layers, int sources) noexcept {
  used_ = 0;
  count_ = 0;
  columns_.sources = sources;
  columns_.source_begin[0] = 0;
  columns_.uniform_sharp = 0;
  const bool has_sharp =
      any(layers, [](const ActiveLayer& layer) { return layer.points->sharp_edges; });
  std::size_t next = 0;
  for (int source = 0; source < sources; ++source) {
    for (; next < layers.size() && layers[next].source == source; ++next) {
      begins_.push_back(used_);
      const std::uint32_t count = selection_.runs()[next].count;
      if (has_sharp && count > 0) {
        const double sharp = layers[next].points->sharp_edges ? 1 : 0;
        std::fill_n(column(kSharp) + used_, count, sharp);
        const bool alike = count_ == 0 || columns_.uniform_sharp == sharp;
        columns_.uniform_sharp = alike ? sharp : -1;
      }
      count_ += count;
      used_ += count;
    }
    pad();
    columns_.source_begin[source + 1] = used_;
  }
}

/// Brings all columns to what the layers are now.
void Patch::fill(std::span<const ActiveLayer> layers) noexcept {
  const bool first = layers_.size() != layers.size();
  layers_.resize(layers.size());  // within what was reserved
  const bool moved = any(layers, [](const ActiveLayer& layer) { return layer.rate > 0; });
  const bool all = first || moved != has_motion_;
  has_motion_ = moved;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const ActiveLayer& now = layers[k];
    const ActiveLayer before = std::exchange(layers_[k], now);
    if (all || now.progress != before.progress || now.weight != before.weight ||
        now.rate != before.rate) {
      fill_layer(k);
    }
  }
  measure();
}

void Patch::fill_layer(std::size_t k) noexcept {
  const ActiveLayer& layer = layers_[k];
  const SurfacePoints& points = *layer.points;
  std::uint32_t at = begins_[k];
  for (const std::uint32_t i : selection_.places(selection_.runs()[k])) {
    const Eigen::Vector3d position = position_now(layer, i, center_);
    for (int axis = 0; axis < 3; ++axis) column(kPosition + axis)[at] = position[axis];
    const double radius = options_.radius > 0 ? options_.radius : radius_now(layer, i);
    column(kRadius)[at] = radius;
    column(kInverseR2)[at] = inverse_square(radius);
    column(kWeight)[at] = weight_now(layer, i, options_.raw_weights) * selection_.stride();
    if (has_materials_)
      column(kMaterial)[at] = points.materials.empty() ? 1.0 : points.materials[i];
    if (has_presences_) column(kPresence)[at] = presence_now(layer, i);
    ++at;
  }
  if (options_.normals) fill_normals(k);
  if (has_motion_) fill_velocities(k);
}

void Patch::fill_normals(std::size_t k) noexcept {
  const ActiveLayer& layer = layers_[k];
  const bool has_normals = !layer.points->normals.empty();
  std::uint32_t at = begins_[k];
  for (const std::uint32_t i : selection_.places(selection_.runs()[k])) {
    const Eigen::Vector3d normal = normal_now(layer, i);
    for (int axis = 0; axis < 3; ++axis) column(kNormal + axis)[at] = normal[axis];
    column(kConfidence)[at++] = has_normals ? confidence_now(layer, i) : 0.0;
  }
}

void Patch::fill_velocities(std::size_t k) noexcept {
  std::uint32_t at = begins_[k];
  for (const std::uint32_t i : selection_.places(selection_.runs()[k])) {
    const Eigen::Vector3d velocity = velocity_now(layers_[k], i);
    for (int axis = 0; axis < 3; ++axis) column(kVelocity + axis)[at] = velocity[axis];
    ++at;
  }
}

/// What is told of all radii.
void Patch::measure() noexcept {
  double sum = 0;
  double largest = 0;
  smallest_radius_ = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < begins_.size(); ++k) {
    const double* const radii = column(kRadius) + begins_[k];
    for (std::uint32_t i = 0; i < selection_.runs()[k].count; ++i) {
      sum += radii[i];
      largest = std::max(largest, radii[i]);
      smallest_radius_ = std::min(smallest_radius_, radii[i]);
    }
  }
  columns_.uniform_radius = smallest_radius_ == largest ? largest : 0;
  mean_radius_ = count_ > 0 ? sum / static_cast<double>(count_) : extra_;
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
