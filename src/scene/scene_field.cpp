// Shows a scene to one servo: follows its sources and answers from patches.
#include "palpate/scene/scene_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "field/evaluate.hpp"
#include "scene/followed_sources.hpp"
#include "scene/patch_cache.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
// How far a patch reaches beyond what it is gathered for, at rest and where points change, and how
// much of that must be left before the next one is gathered; in R (judgement).
constexpr double kMargin = 0.35;
constexpr double kWideMargin = 0.62;  // R; judgement
constexpr double kReserve = 0.1;      // R
constexpr double kToolShare = 0.3;    // R; the largest tool radius that counts in full (judgement)
constexpr double kFinest = 0.25;      // mean R; the least radius that sweeps follow (judgement)
constexpr double kFelt = 2;  // R around a tool; normals beside rims need neighbours (judgement)
}  // namespace

struct SceneField::State {
  State(Scene& scene, const FieldOptions& options, const std::string& name, double scale)
      : surface(options), followed(scene, name, scale) {}

  /// m, of the points around the proxy, or of all.
  [[nodiscard]] double radius() const noexcept {
    return patches.near().points() > 0 ? patches.near().columns().mean_radius
                                       : followed.layers().typical_radius();
  }
  /// How far a patch away from the path reaches beyond what it is gathered for, m.
  [[nodiscard]] double margin() const noexcept {
    return (followed.layers().moving ? kWideMargin : kMargin) * radius();
  }
  void gather_path(const Vector3d& hip, const Vector3d& proxy) noexcept;
  [[nodiscard]] FieldNote standing_notes() const noexcept;

  ImplicitSurface surface;
  FollowedSources followed;
  FieldNote notes = FieldNote::none;
  std::uint64_t revision = 0;
  std::uint32_t stride = 1;  // of the near patch
  PatchCache patches{surface};
};

/// Notes that hold whatever is sampled.
FieldNote SceneField::State::standing_notes() const noexcept {
  const ActiveLayers& layers = followed.layers();
  FieldNote found = layers.count > 0 ? FieldNote::none : FieldNote::no_surface;
  const Patch& near = patches.near();
  if (near.thinned()) found = found | FieldNote::thinned;
  if (near.points() > 0 && near.sides().is_behind()) found = found | FieldNote::behind;
  if (layers.other_kernel && !surface.options.raw_weights) found = found | FieldNote::other_kernel;
  const double tool = (1 + 1e-6) * std::min(kToolShare, surface.largest_tool);
  if (near.points() > 0 && surface.options.tool_radius > tool * near.columns().smallest_radius) {
    found = found | FieldNote::tool_too_large;
  }
  return found;
}

/// Points around the proxy and the first stretch of its path to the hand.
void SceneField::State::gather_path(const Vector3d& hip, const Vector3d& proxy) noexcept {
  const double r = radius();
  const Vector3d offset = hip - proxy;
  const double length = offset.norm();
  const double stretch = std::min(length, r);
  const Vector3d end = length > 0 ? Vector3d(proxy + offset * (stretch / length)) : proxy;
  const std::array balls{Ball{proxy, kReserve * r}, Ball{end, kReserve * r}};
  const bool wide = std::ranges::any_of(followed.layers().active(), moves);
  const double extra = 0.5 * stretch + (wide ? kWideMargin : kMargin) * r;
  if (!patches.near_covers(balls, extra)) patches.gather_near(0.5 * (proxy + end), extra);
}

SceneField::SceneField(Scene& scene, const FieldOptions& options, const std::string& name,
                       double scale)
    : options_(options), state_(std::make_unique<State>(scene, options, name, scale)) {}

SceneField::~SceneField() = default;

void SceneField::update_from(double now, const Vector3d& hip, const Vector3d& place) noexcept {
  State& state = *state_;
  FollowedSources& followed = state.followed;
  if (followed.advance(now, options_)) {
    state.patches.set_layers(followed.layers().active(), followed.sources(), followed.same());
    ++state.revision;
  }
  state.patches.begin_update();
  if (hip.allFinite() && place.allFinite()) {
    if (options_.nearest_radius)
      state.patches.take_nearest_radius(place, followed.layers().typical_radius());
    state.patches.set_tool(place);
    state.gather_path(hip, place);
    state.patches.face_near();
    followed.report(hip, place, kFelt * state.radius());
    const std::uint32_t stride = state.patches.near().selection().stride();
    if (std::exchange(state.stride, stride) != stride) ++state.revision;  // another surface
  }
  state.notes = state.standing_notes();
  if (followed.misses({place, state.radius()})) state.notes = state.notes | FieldNote::not_loaded;
  if (!std::isfinite(now)) state.notes = state.notes | FieldNote::time_not_finite;
}

Sample SceneField::sample(const Vector3d& x) const noexcept {
  const State& state = *state_;
  if (state.followed.layers().count == 0 || !x.allFinite())
    return {.value = 1};  // free, how far unknown
  const Patch* const patch = state.patches.patch_for({x, 0}, state.margin());
  if (patch) return evaluate(state.surface, *patch, x);
  return {.value = -state.radius(), .support = 1, .radius = state.radius()};  // solid where unknown
}

bool SceneField::is_free(const Ball& ball) const noexcept {
  const State& state = *state_;
  if (state.followed.layers().count == 0) return true;
  if (!ball.center.allFinite() || !std::isfinite(ball.radius)) return false;
  const bool small = ball.radius <= 0.5 * kMargin * state.radius();
  if (!small && !state.patches.covers(ball)) return state.patches.walk_is_free(ball);
  const Patch* const patch = state.patches.patch_for(ball, state.margin());
  return patch && palpate::is_free(state.surface, *patch, ball);
}

void SceneField::change(const FieldOptions& checked) noexcept {
  if (checked == options_) return;  // nothing to gather again
  options_ = checked;
  state_->surface.change(checked);
  state_->followed.list(options_);
  state_->patches.forget();
  ++state_->revision;
}

void SceneField::begin_step() const noexcept {
  state_->patches.begin_step();
}
int SceneField::points_summed() const noexcept {
  return state_->patches.work().summed;
}
void SceneField::end_step(const Vector3d& proxy, const Vector3d& normal) const noexcept {
  state_->patches.end_step({proxy, normal});
}

Surface SceneField::surface(const Vector3d& x) const noexcept {
  const State& state = *state_;
  if (state.followed.layers().count == 0 || !x.allFinite()) return {};
  if (state.followed.plain()) return {.source = 0};
  const Patch* const patch = state.patches.patch_for({x, 0}, state.margin());
  return patch ? state.followed.surface(state.surface, *patch, x) : Surface{};
}

Field::Traits SceneField::traits() const noexcept {
  const State& state = *state_;
  const bool metaball = options_.kind == FieldOptions::Kind::metaball;
  // One finely sampled spot must not make sweeps fine everywhere.
  const double smallest =
      std::max(state.patches.near().points() > 0 ? state.patches.near().columns().smallest_radius
                                                 : state.followed.layers().typical_radius(),
               kFinest * state.radius());
  return {.resolution = metaball ? 0.002 * smallest : smallest / 16,
          .revision = state.revision,
          .reanchor_reach = kFastestCloud * state.followed.layers().cloud_duration,
          .step = state.followed.step()};
}

SceneField::Found SceneField::found() const noexcept {
  return state_->followed.found();
}
FieldNote SceneField::notes() const noexcept {
  return state_->notes | state_->patches.work().notes;
}
std::size_t SceneField::patch_points() const noexcept {
  return state_->patches.near().points();
}
std::uint64_t SceneField::gathers() const noexcept {
  return state_->patches.work().gathers;
}
std::uint64_t SceneField::visits() const noexcept {
  return state_->patches.work().visits;
}

}  // namespace palpate
