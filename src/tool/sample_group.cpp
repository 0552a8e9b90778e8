// Gathers the points near the groups of a tool's samples, and bounds the work of a step.
#include "tool/sample_group.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/probe.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// R that a patch reaches beyond the samples that it is gathered for: as for a point (judgement).
constexpr double kMargin = 0.35;
// Cosine: points are above a sample and not beside it, as at a rim, where the way out leads down
// within 60 degrees (judgement).
constexpr double kBehind = 0.5;
constexpr double kMoved = 0.15;  // R after which sides are decided again: as for a point

}  // namespace

void TouchedScene::begin_update() noexcept {
  work_.notes = FieldNote::none;
  for (Away& away : away_) away.patch.clear();
}

void TouchedScene::begin_step() noexcept {
  gather_visits_ = kGatherVisits;
  free_visits_ = kFreeVisits;
}

bool TouchedScene::gather(Patch& patch, const Ball& ball, const Stance& stance) noexcept {
  if (gather_visits_ <= 0) {
    work_.notes = work_.notes | FieldNote::work_spent;
    return false;
  }
  const bool whole =
      patch.gather(followed.layers().active(), followed.sources(), ball.center, ball.radius,
                   {.raw_weights = surface.options.raw_weights,
                    .normals = surface.options.kind != FieldOptions::Kind::metaball,
                    .rise = surface.rise,
                    .most_visits = gather_visits_,
                    .stance = &stance});
  count(patch, whole);
  return whole;
}

bool TouchedScene::renew(Patch& patch, const Stance& stance) noexcept {
  if (gather_visits_ <= 0) {
    patch.clear();
    work_.notes = work_.notes | FieldNote::work_spent;
    return false;
  }
  const bool whole =
      patch.renew(followed.layers().active(), followed.sources(), gather_visits_, &stance);
  count(patch, whole);
  return whole;
}

/// The work of a gather.
void TouchedScene::count(const Patch& patch, bool whole) noexcept {
  gather_visits_ -= patch.selection().visits();
  if (patch.thinned()) work_.notes = work_.notes | FieldNote::thinned;
  if (!whole) work_.notes = work_.notes | FieldNote::work_spent;
  work_.visits += static_cast<std::uint64_t>(patch.selection().visits());
  ++work_.gathers;
}

bool TouchedScene::walk_is_free(const Ball& ball) noexcept {
  const int before = free_visits_;
  const bool free =
      is_free_space(surface, followed.layers().active(), followed.sources(), ball, 0, free_visits_);
  if (free_visits_ <= 0) work_.notes = work_.notes | FieldNote::work_spent;
  work_.visits += static_cast<std::uint64_t>(before - free_visits_);
  return free;
}

const Patch* TouchedScene::patch_away(const Vector3d& x, const SampleGroup* of) noexcept {
  for (const std::size_t k : {latest_, 1 - latest_}) {
    if (away_[k].of != of || !away_[k].patch.covers({x, 0})) continue;
    latest_ = k;
    return &away_[k].patch;
  }
  latest_ = 1 - latest_;
  Away& oldest = away_[latest_];
  oldest.of = of;
  oldest.patch.sides().forget();
  if (of) oldest.patch.sides().follow(of->patch().sides());
  const double margin = kMargin * (of ? of->radius() : radius());
  return gather(oldest.patch, {x, margin}, {x, Vector3d::Zero()}) ? &oldest.patch : nullptr;
}

Sample TouchedScene::sample(const Patch* patch, const Vector3d& x) noexcept {
  if (!patch) return {.value = -radius(), .support = 1, .radius = radius()};
  Sample here = evaluate(surface, *patch, x);
  if (patch->points() == 0) here.radius = 0;  // nothing is there that has one
  return here;
}

bool TouchedScene::is_behind(const Patch* patch, const Vector3d& x, double deeper) const noexcept {
  if (!patch) return true;
  const Sample here = evaluate(surface, *patch, x);
  if (here.behind) return true;  // of what was seen from the other side alone
  ImplicitSurface planes = surface;
  planes.options.capped = false;
  const Sample below = evaluate(planes, *patch, x);
  const std::optional<double> height = first_order_distance(below);
  if (!height || *height >= -deeper) return false;
  return here.gradient.normalized().dot(below.gradient.normalized()) < -kBehind;
}

Vector3d TouchedScene::middle_of(int side) const noexcept {
  for (const std::int32_t index : tool_->roots()) {
    const Tool::Node& root = tool_->nodes()[static_cast<std::size_t>(index)];
    if (root.side == side) return ball_of(root).center;
  }
  return pose_.position;
}

Surface TouchedScene::made_of(const Patch* patch, const Vector3d& x) noexcept {
  if (!patch) return {};
  return followed.plain() ? Surface{.source = 0} : followed.surface(surface, *patch, x);
}

void SampleGroup::assign(const Tool::Node& node, AgreedSides& finger) noexcept {
  node_ = &node;
  finger_ = &finger;
  release();
}

void SampleGroup::release() noexcept {
  now_.looks = false;
  now_.patch.clear();
}

double SampleGroup::radius() const noexcept {
  return now_.patch.extra() >= 0 && now_.patch.points() > 0 ? now_.patch.columns().mean_radius
                                                            : scene_->radius();
}

void SampleGroup::update(double passed, bool changed, bool same) noexcept {
  now_.ready = false;
  now_.unlooked += passed;
  if (now_.unlooked > AgreedSides::kKept) now_.looks = false;
  if (!changed) return;
  now_.stale = true;
  if (same) return;
  now_.others = true;
  // Nobody has renewed it: its layers may be gone, and others come to their addresses.
  if (now_.patch.outdated()) now_.patch.clear();
  if (now_.patch.extra() < 0) now_.patch.sides().forget();
  now_.patch.advance(scene_->followed.layers().active());
}

/// Sides are those that a sample sees from where it looks, and a little farther inside of the tool:
/// of a surface that it lies on, rounding would decide.
void SampleGroup::begin_at(const Vector3d& x) const noexcept {
  const Vector3d inward = scene_->middle_of(node_->side) - x;
  const double lift = static_cast<double>(kLift) * radius();
  const Vector3d eye = x + lift / std::max(inward.norm(), lift) * inward;
  now_.looks = now_.others = true;
  now_.stance = now_.faced = {eye, Vector3d::Zero(), 2 * node_->radius, finger_};
  now_.patch.sides().forget();
}

/// Do sides have to be decided again, as the tool has moved or the surface is another one? Then
/// they are reopened where the tool is free.
bool SampleGroup::turns() const noexcept {
  const double moved = (now_.stance.proxy - now_.faced.proxy).norm();
  const bool same = now_.stance.touches() == now_.faced.touches() && moved < kMoved * radius();
  if (!std::exchange(now_.others, false) && same) return false;
  now_.faced = now_.stance;
  const Ball here{now_.stance.proxy, 0};
  const bool free = !now_.stance.touches() &&
                    (now_.patch.covers(here) ? palpate::is_free(scene_->surface, now_.patch, here)
                                             : scene_->walk_is_free(here));
  if (free) now_.patch.sides().reopen();
  return true;
}

/// Brings points and sides to what they are in this update.
void SampleGroup::make_ready() const noexcept {
  now_.ready = true;
  now_.unlooked = 0;
  const bool stale = std::exchange(now_.stale, false);
  if (stale) now_.patch.advance(scene_->followed.layers().active());
  const bool turns_now = turns();
  if (now_.patch.outdated()) {
    scene_->renew(now_.patch, now_.stance);
  } else if (turns_now && now_.patch.covers({now_.stance.proxy, 0})) {
    now_.patch.face(now_.stance);
  }
  if (now_.patch.extra() >= 0) now_.patch.sides().confirm(*finger_);
}

const Patch* SampleGroup::patch_for(const Vector3d& x) const noexcept {
  if (!now_.looks) begin_at(x);
  if (!now_.ready) make_ready();
  if (now_.patch.covers({x, 0})) return &now_.patch;
  Ball ball = scene_->ball_of(*node_);
  ball.radius += kMargin * radius();
  if ((ball.center - x).norm() > ball.radius) return scene_->patch_away(x, this);
  return scene_->gather(now_.patch, ball, now_.stance) ? &now_.patch : nullptr;
}

Sample SampleGroup::sample(const Vector3d& x) const noexcept {
  if (scene_->is_empty() || !x.allFinite()) return {.value = 1};  // free, how far is unknown
  return scene_->sample(patch_for(x), x);
}

bool SampleGroup::is_free(const Ball& ball) const noexcept {
  if (scene_->is_empty()) return true;
  if (!ball.center.allFinite() || !std::isfinite(ball.radius)) return false;
  return now_.ready && now_.patch.covers(ball) ? palpate::is_free(scene_->surface, now_.patch, ball)
                                               : scene_->walk_is_free(ball);
}

bool SampleGroup::is_behind(double deeper) const noexcept {
  Ball reach = scene_->ball_of(*node_);
  reach.radius += radius();  // points beyond say nothing
  if (scene_->walk_is_free(reach)) return false;
  return std::ranges::any_of(scene_->samples_of(*node_), [&](const Tool::Point& sample) {
    const Vector3d x = scene_->in_world(sample);
    return scene_->is_behind(patch_for(x), x, deeper);
  });
}

Surface SampleGroup::surface(const Vector3d& x) const noexcept {
  if (scene_->is_empty() || !x.allFinite()) return {};
  return scene_->made_of(patch_for(x), x);
}

void SampleGroup::end_step(const Vector3d& proxy, const Vector3d& normal) const noexcept {
  now_.stance = {proxy, normal, 2 * node_->radius, finger_};
}

}  // namespace palpate
