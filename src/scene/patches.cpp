#include <algorithm>
#include <utility>

#include "field/evaluate.hpp"
#include "scene/scene_view.hpp"

namespace palpate {

using Eigen::Vector3d;

void Patches::show(std::span<const ActiveLayer> layers, int sources, bool same) noexcept {
  layers_ = layers;
  sources_ = sources;
  if (!same) far_.clear();
  others_ = others_ || !same;
  // Nobody has renewed it: its layers may be gone, and others come to their addresses.
  if (near_.outdated()) near_.clear();
  near_.advance(layers_);
  far_is_late_ = true;
}

void Patches::stand(const Vector3d& proxy) noexcept {
  constexpr double kMoved = 0.15;  // R after which sheets further on come into view
  // A proxy that has been moved since its step touches nothing.
  const Stance stance = last_.proxy == proxy ? last_ : Stance{proxy, Vector3d::Zero()};
  stance_ = stance;
  const double moved = (stance.proxy - faced_.proxy).norm();
  const bool same = stance.touches() == faced_.touches() && moved < kMoved * near_.mean_radius();
  if (!std::exchange(others_, false) && same) return;
  faced_ = stance;
  const Ball here{stance.proxy, 0};
  const bool covered = near_.covers(here);
  // A step that went beyond the near patch knows from which side it came.
  if (!covered && far_.covers(here)) near_.follow_sides(far_);
  far_.clear();
  far_.forget_sides();
  const bool free =
      !stance.touches() && (covered ? is_free(*surface_, near_, here) : walk_is_free(here));
  if (free) near_.forget_sides();
  to_face_ = covered;
}

void Patches::face_near() noexcept {
  if (std::exchange(to_face_, false)) near_.face(stance_);
}

void Patches::forget() noexcept {
  near_.clear();
  near_.forget_sides();
  far_.clear();
  radius_ = 0;
}

void Patches::choose_radius(const Vector3d& x, double first) noexcept {
  const double before = std::exchange(radius_, 0);
  const double nearest = gather(far_, x, 0, update_visits_) ? far_.nearest_radius(x) : 0;
  radius_ = nearest > 0 ? nearest : before > 0 ? before : first;
  far_.clear();
  if (radius_ != before) near_.clear();
}

void Patches::gather_near(const Vector3d& center, double extra) noexcept {
  to_face_ = false;
  gather(near_, center, extra, update_visits_);
}

bool Patches::near_covers(std::span<const Ball> balls, double extra) noexcept {
  constexpr double kTooWide = 4;  // a patch that lacks points for the sake of far ones
  if (near_.thinned() && near_.extra() > kTooWide * extra) return false;
  const auto reached = [this](const Ball& ball) { return near_.reaches(ball); };
  if (near_.outdated() && std::ranges::all_of(balls, reached)) {
    to_face_ = false;
    count(near_, near_.renew(layers_, sources_, update_visits_, &stance_), update_visits_);
  }
  return std::ranges::all_of(balls, [this](const Ball& ball) { return near_.covers(ball); });
}

const Patch* Patches::at(const Ball& ball, double margin) const noexcept {
  // Balls that are asked about in the time of one sum for a sample, and sums in that of a gather.
  constexpr int kBallsASum = 4;
  constexpr int kSumsAGather = 20;
  const std::uint64_t before = gathers_;
  const Patch* const patch = find(ball, margin);
  if (!patch || !stepping_) return patch;
  const auto points = static_cast<int>(patch->points());
  summed_ += ball.radius > 0 ? points / kBallsASum : points;
  if (gathers_ != before) summed_ += kSumsAGather * points;
  return patch;
}

const Patch* Patches::find(const Ball& ball, double margin) const noexcept {
  if (near_.covers(ball)) return &near_;
  if (far_.covers(ball) && (!far_is_late_ || far_.advance(layers_))) {
    far_is_late_ = false;
    return &far_;
  }
  far_is_late_ = false;
  if (!stepping_) far_.forget_sides();  // what a step has seen once, it sees so to its end
  far_.follow_sides(near_);
  int alone = kGatherVisits;
  int& left = stepping_ ? gather_visits_ : alone;
  return gather(far_, ball.center, std::max(margin, ball.radius), left) ? &far_ : nullptr;
}

bool Patches::walk_is_free(const Ball& ball) const noexcept {
  int left = stepping_ ? free_visits_ : kFreeVisits;
  const int before = left;
  const bool free = is_free_space(*surface_, layers_, sources_, ball, radius_, left);
  if (stepping_) free_visits_ = left;
  if (left <= 0) notes_ = notes_ | FieldNote::work_spent;
  visits_ += static_cast<std::uint64_t>(before - left);
  return free;
}

bool Patches::gather(Patch& patch, const Vector3d& center, double extra, int& left) const noexcept {
  const bool whole =
      patch.gather(layers_, sources_, center, extra,
                   {.radius = radius_,
                    .raw_weights = surface_->options.raw_weights,
                    .normals = surface_->options.kind != FieldOptions::Kind::metaball,
                    .rise = surface_->rise,
                    .most_visits = left,
                    .stance = &stance_});
  count(patch, whole, left);
  return whole;
}

/// The work of a gather.
void Patches::count(const Patch& patch, bool whole, int& left) const noexcept {
  left -= patch.visits();
  if (patch.thinned()) notes_ = notes_ | FieldNote::thinned;
  if (!whole) notes_ = notes_ | FieldNote::work_spent;
  visits_ += static_cast<std::uint64_t>(patch.visits());
  ++gathers_;
}

void Patches::begin_update() noexcept {
  update_visits_ = kGatherVisits;
  notes_ = FieldNote::none;
}

void Patches::begin_step() const noexcept {
  stepping_ = true;
  gather_visits_ = kGatherVisits;
  free_visits_ = kFreeVisits;
  summed_ = 0;
}

void Patches::end_step(const Stance& last) const noexcept {
  stepping_ = false;
  last_ = last;
}

}  // namespace palpate
