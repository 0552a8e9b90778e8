// Follows the sources of a scene for one field, and reports its tool's reach to them.
#include "scene/followed_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "scene/source_inside.hpp"

namespace palpate {

static_assert(Scene::kMaxSources <= simd::kMaxSources);
static_assert(Scene::kMaxSources * Snapshot::kMaxLayers <= kMostLayers);

FollowedSources::FollowedSource::FollowedSource(Source::Inside& source,
                                                const SourceOptions::SoftMaterial& its_soft,
                                                const std::string& name)
    : view(source.handoff, source.slot.seams->least_radius(source.slot.number), name),
      board(&source.reaches),
      soft(its_soft) {}

FollowedSources::FollowedSources(Scene& scene, const std::string& name, double scale)
    : fields_(scene.fields_), reach_(scale) {
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    sources_.emplace_back(*source.inside_, source.options().soft, name);
  }
  ++*fields_;
}

FollowedSources::~FollowedSources() {
  for (const FollowedSource& source : sources_) source.board->clear(source.view.reader());
  --*fields_;
}

bool FollowedSources::advance(double now, const FieldOptions& options) noexcept {
  if (std::isfinite(now)) now_ = now;
  bool changed = false;
  step_ = 0;
  for (FollowedSource& source : sources_) changed = source.view.advance(now_) || changed;
  if (!changed) return false;
  same_ = same_snapshots();
  list(options);
  return true;
}

/// Are the views' snapshots those of the last call? A new one never has the old one's address.
bool FollowedSources::same_snapshots() noexcept {
  bool same = true;
  for (FollowedSource& source : sources_) {
    const Snapshot* const newest = source.view.current();
    if (std::exchange(source.shown, newest) == newest) continue;
    same = false;
    if (newest) step_ = std::max(step_, kFastestCloud * time_stepped(*newest, layers_.active()));
  }
  return same;
}

void FollowedSources::list(const FieldOptions& options) noexcept {
  layers_.clear();
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    layers_.add(sources_[s].view, static_cast<int>(s), options);
  }
}

void FollowedSources::report(const Eigen::Vector3d& hip, const Eigen::Vector3d& proxy,
                             double felt) noexcept {
  const Reach ball = reach_.update(now_, hip, proxy, layers_.frame_interval, felt);
  for (const FollowedSource& source : sources_) source.board->write(source.view.reader(), ball);
}

bool FollowedSources::plain() const noexcept {
  return layers_.plain_points && sources_.size() == 1 && sources_.front().view.presence() == 1;
}

Surface FollowedSources::surface(const ImplicitSurface& surface, const Patch& patch,
                                 const Eigen::Vector3d& x) const noexcept {
  std::array<double, Scene::kMaxSources> present{};
  const auto presence = [](const FollowedSource& source) { return source.view.presence(); };
  std::ranges::transform(sources_, present.begin(), presence);
  const auto presences = std::span(present).first(sources_.size());
  const PatchSurface mean = mean_surface(surface, patch, x, presences);
  if (mean.source < 0) return {};
  return felt_surface(mean, sources_[static_cast<std::size_t>(mean.source)].soft);
}

bool FollowedSources::misses(const Ball& ball) const noexcept {
  return std::ranges::any_of(sources_,
                             [&](const FollowedSource& each) { return each.view.misses(ball); });
}

SceneField::Found FollowedSources::found() const noexcept {
  SceneField::Found found;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    found.publications[i] = sources_[i].view.taken();
    found.least_radii[i] = sources_[i].view.least_radius();
  }
  return found;
}

}  // namespace palpate
