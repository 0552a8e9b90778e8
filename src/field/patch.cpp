// Gathers the points of a patch, follows their layers, and has them turned to the tool.

#include "field/patch.hpp"

#include <algorithm>
#include <array>

namespace palpate {
namespace {

std::size_t whole_lanes(std::size_t points) noexcept {
  return (points + simd::kLanes - 1) / simd::kLanes * simd::kLanes;
}

/// Is this the k-th layer that was gathered, and its progress still in the range of its run?
bool follows(const ActiveLayer& now, const GatheredPoints& points, std::size_t k) noexcept {
  const ActiveLayer& before = points.layers[k];
  const Selection::Run& run = points.selection.runs()[k];
  const bool same = now.points == before.points && now.source == before.source &&
                    now.least_radius == before.least_radius;
  const bool in_range =
      !has_end(*now.points) || (now.progress >= run.from && now.progress <= run.until);
  return same && in_range && (run.counts || !(now.weight > 0));
}

}  // namespace

Patch::Patch(std::size_t capacity)
    : points_(whole_lanes(capacity)),
      columns_(whole_lanes(capacity)),
      facing_(whole_lanes(capacity)) {}

bool Patch::gather(std::span<const ActiveLayer> layers, int sources, const Eigen::Vector3d& center,
                   double extra, const GatherOptions& options) noexcept {
  points_.ball = {center, extra};
  points_.options = options;
  const bool whole = points_.selection.choose(layers, points_.ball,
                                              {.radius = options.radius,
                                               .raw_weights = options.raw_weights,
                                               .most_visits = options.most_visits});
  copy(layers, sources, whole);
  return whole;
}

bool Patch::advance(std::span<const ActiveLayer> layers) noexcept {
  if (extra() < 0 || outdated_) return false;
  outdated_ = layers.size() != points_.layers.size();
  for (std::size_t k = 0; !outdated_ && k < layers.size(); ++k) {
    outdated_ = !follows(layers[k], points_, k);
  }
  if (!outdated_) columns_.advance(points_, layers);
  return !outdated_;
}

bool Patch::renew(std::span<const ActiveLayer> layers, int sources, int most_visits,
                  const Stance* stance) noexcept {
  points_.options.stance = stance;
  std::array<std::size_t, kMostLayers> before{};
  for (std::size_t n = 0; n < std::min(layers.size(), kMostLayers); ++n) {
    std::size_t k = 0;
    while (k < points_.layers.size() && !follows(layers[n], points_, k)) ++k;
    before[n] = k < points_.layers.size() ? k : Selection::kNone;
  }
  const bool whole = points_.selection.renew(layers, before, most_visits);
  copy(layers, sources, whole);
  return whole;
}

/// Copies what was chosen into the columns.
void Patch::copy(std::span<const ActiveLayer> layers, int sources, bool whole) noexcept {
  if (!whole) {
    clear();
    layers = {};
  }
  outdated_ = false;
  std::size_t count = 0;
  for (const Selection::Run& run : points_.selection.runs()) count += run.count;
  points_.sources = sources;
  points_.layers.assign(layers.begin(), layers.end());  // within what was reserved
  points_.signs.assign(count, 1);
  points_.labels.assign(count, kNearFace);
  if (points_.options.stance && whole) turn(*points_.options.stance);
  points_.options.stance = nullptr;
  eyes_.begin(center());
  for (std::size_t k = 0; k < layers.size(); ++k) {
    eyes_.add(layers[k], points_.selection.indices(points_.selection.runs()[k]));
  }
  columns_.write(points_);
}

bool Patch::turn(const Stance& stance) noexcept {
  GatheredPoints& p = points_;
  const auto one_sided = [](const ActiveLayer& layer) { return layer.points->one_sided(); };
  const bool sided = p.options.normals || std::ranges::any_of(p.layers, one_sided);
  if (!sided && !p.layers.empty()) return false;
  return facing_.face({p.layers, &p.selection, p.signs, p.labels, p.options.rise}, stance);
}

void Patch::face(const Stance& stance) noexcept {
  if (extra() < 0 || outdated_ || !turn(stance)) return;
  columns_.sort(points_);
}

}  // namespace palpate
