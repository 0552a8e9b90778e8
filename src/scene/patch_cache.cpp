// Gathers patches when they are needed, and bounds the work of a step.
#include "scene/patch_cache.hpp"

#include <algorithm>
#include <utility>

namespace palpate {

using Eigen::Vector3d;

void PatchCache::set_layers(std::span<const ActiveLayer> layers, int sources, bool same) noexcept {
  layers_ = layers;
  sources_ = sources;
  for (Slot& far : step_.far) {
    if (!same) far.patch.clear();
    far.stale = true;
  }
  others_ = others_ || !same;
  // Nobody has renewed it: its layers may be gone, and others come to their addresses.
  if (near_.patch.outdated()) near_.patch.clear();
  near_.patch.advance(layers_);
}

void PatchCache::set_tool(const Vector3d& proxy) noexcept {
  constexpr double kMoved = 0.15;  // R after which segments further on come into view
  // A proxy that has been moved since its step touches nothing.
  tool_ = step_.last.proxy == proxy ? step_.last : Stance{proxy, Vector3d::Zero()};
  const double moved = (tool_.proxy - faced_.proxy).norm();
  const bool same =
      tool_.touches() == faced_.touches() && moved < kMoved * near_.patch.columns().mean_radius;
  if (!std::exchange(others_, false) && same) return;
  faced_ = tool_;
  const Ball here{tool_.proxy, 0};
  const bool covered = near_.patch.covers(here);
  // A step that went beyond the near patch has stored from which side it came.
  for (const std::size_t k : {1 - step_.latest, step_.latest}) {
    const Patch& far = step_.far[k].patch;
    if (!covered && far.covers(here)) near_.patch.sides().follow(far.sides());
  }
  clear_far();
  const bool free =
      !tool_.touches() && (covered ? is_free(*surface_, near_.patch, here) : walk_is_free(here));
  if (free) near_.patch.sides().reopen();
  near_.stale = covered;
}

void PatchCache::face_near() noexcept {
  if (std::exchange(near_.stale, false)) near_.patch.face(tool_);
}

void PatchCache::forget() noexcept {
  near_.patch.clear();
  near_.patch.sides().forget();
  clear_far();
  radius_ = 0;
}

void PatchCache::clear_far() noexcept {
  for (Slot& far : step_.far) {
    far.patch.clear();
    far.patch.sides().forget();
  }
}

void PatchCache::take_nearest_radius(const Vector3d& x, double first) noexcept {
  const double before = std::exchange(radius_, 0);
  Patch& patch = step_.far[0].patch;
  const double nearest =
      gather(patch, x, 0, update_visits_) ? patch.columns().nearest_radius(x - patch.center()) : 0;
  radius_ = nearest > 0 ? nearest : before > 0 ? before : first;
  for (Slot& far : step_.far) far.patch.clear();
  if (radius_ != before) near_.patch.clear();
}

void PatchCache::gather_near(const Vector3d& center, double extra) noexcept {
  near_.stale = false;
  gather(near_.patch, center, extra, update_visits_);
}

bool PatchCache::near_covers(std::span<const Ball> balls, double extra) noexcept {
  constexpr double kTooWide = 4;  // times `extra`: a patch lacks points for the sake of far ones
  if (near_.patch.thinned() && near_.patch.extra() > kTooWide * extra) return false;
  const auto reached = [this](const Ball& ball) { return near_.patch.reaches(ball); };
  if (near_.patch.outdated() && std::ranges::all_of(balls, reached)) {
    near_.stale = false;
    count(near_.patch, near_.patch.renew(layers_, sources_, update_visits_, &tool_),
          update_visits_);
  }
  return std::ranges::all_of(balls, [this](const Ball& ball) { return near_.patch.covers(ball); });
}

const Patch* PatchCache::patch_for(const Ball& ball, double margin) const noexcept {
  // Balls that are tested in the time of one sum for a sample, and sums in that of a gather.
  constexpr int kBallsASum = 4;
  constexpr int kSumsAGather = 20;  // judgement, both
  const std::uint64_t before = step_.work.gathers;
  const Patch* const patch = find(ball, margin);
  if (!patch || !step_.running) return patch;
  const auto points = static_cast<int>(patch->points());
  step_.work.summed += ball.radius > 0 ? points / kBallsASum : points;
  if (step_.work.gathers != before) step_.work.summed += kSumsAGather * points;
  return patch;
}

const Patch* PatchCache::find(const Ball& ball, double margin) const noexcept {
  if (near_.patch.covers(ball)) return &near_.patch;
  for (const std::size_t k : {step_.latest, 1 - step_.latest}) {
    Slot& far = step_.far[k];
    if (!far.patch.covers(ball) || (far.stale && !far.patch.advance(layers_))) continue;
    far.stale = false;
    step_.latest = k;
    return &far.patch;
  }
  int alone = kGatherVisits;
  int& left = step_.running ? step_.gather_visits : alone;
  if (left <= 0) {  // the patches that there are stay
    step_.work.notes = step_.work.notes | FieldNote::work_spent;
    return nullptr;
  }
  const Facing& seen = step_.far[step_.latest].patch.sides();
  step_.latest = 1 - step_.latest;
  Slot& oldest = step_.far[step_.latest];
  oldest.stale = false;
  // What a step has seen once, it sees so to its end.
  if (step_.running) oldest.patch.sides().follow(seen);
  if (!step_.running) oldest.patch.sides().forget();
  oldest.patch.sides().follow(near_.patch.sides());
  return gather(oldest.patch, ball.center, std::max(margin, ball.radius), left) ? &oldest.patch
                                                                                : nullptr;
}

bool PatchCache::walk_is_free(const Ball& ball) const noexcept {
  int left = step_.running ? step_.free_visits : kFreeVisits;
  const int before = left;
  const bool free = is_free_space(*surface_, layers_, sources_, ball, radius_, left);
  if (step_.running) step_.free_visits = left;
  if (left <= 0) step_.work.notes = step_.work.notes | FieldNote::work_spent;
  step_.work.visits += static_cast<std::uint64_t>(before - left);
  return free;
}

bool PatchCache::gather(Patch& patch, const Vector3d& center, double extra,
                        int& left) const noexcept {
  const bool whole =
      patch.gather(layers_, sources_, center, extra,
                   {.radius = radius_,
                    .raw_weights = surface_->options.raw_weights,
                    .normals = surface_->options.kind != FieldOptions::Kind::metaball,
                    .rise = surface_->rise,
                    .most_visits = left,
                    .stance = &tool_});
  count(patch, whole, left);
  return whole;
}

/// The work of a gather.
void PatchCache::count(const Patch& patch, bool whole, int& left) const noexcept {
  left -= patch.selection().visits();
  if (patch.thinned()) step_.work.notes = step_.work.notes | FieldNote::thinned;
  if (!whole) step_.work.notes = step_.work.notes | FieldNote::work_spent;
  step_.work.visits += static_cast<std::uint64_t>(patch.selection().visits());
  ++step_.work.gathers;
}

void PatchCache::begin_update() noexcept {
  update_visits_ = kGatherVisits;
  step_.work.notes = FieldNote::none;
}

void PatchCache::begin_step() const noexcept {
  step_.running = true;
  step_.gather_visits = kGatherVisits;
  step_.free_visits = kFreeVisits;
  step_.work.summed = 0;
}

void PatchCache::end_step(const Stance& tool) const noexcept {
  step_.running = false;
  step_.last = tool;
}

}  // namespace palpate
