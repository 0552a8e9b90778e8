#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/policies/morph.hpp"

// What becomes of each point of a morphing surface: what a block shows next decides.

namespace palpate {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Of the blocks around one, how many have to show the same surface: those of a line.
constexpr float kVouch = 0.25f;

// What has faded so far is gone.
constexpr float kGone = 1e-4f;

// In which trust in what has been seen through, or is hidden, goes, s: what is gone five times as
// slowly as a proxy's spring follows (EnergyTank::kTime); what hides a thing may take it along.
constexpr double kGoes = 0.1;
constexpr double kHidden = 60;

}  // namespace

/// What becomes of one block: of the point that the frame has there, and of the old ones. What lies
/// nearer than what is seen now has been seen through; what lies farther is hidden.
void Morph::settle(const FilteredDepth& depth, std::size_t place) {
  const std::span<const std::uint32_t> old = by_block_.at(place);
  const std::size_t block = order_.blocks[place];
  const Point& point = points_[block];
  const bool shown = point.state.radius > 0;
  if (!shown && old.empty()) return;
  place_ = static_cast<std::uint32_t>(place);
  if (!shown) return hold_one(old);
  PointState before;
  const std::uint32_t partner = partner_of(depth, old, point, before);
  const bool flies = partner == kNone ? last_ && beside(depth, block) < kVouch
                                      : turns_away(point, partner, before);
  if (flies) return hold_one(old);
  float at = depth_of(point.state.position);
  if (partner == kNone) {
    appear(point);
  } else if (stays(depth, point, before)) {
    at = depth_of(before.position);
    keep(partner, before, before.presence + comes_, EntryKind::live, moment_.stamp);
  } else {
    follow(point, partner, before);
  }
  for (const std::uint32_t i : old) {
    if (i == partner) continue;
    const EntryKind kind = entries_[i].kind;
    const float beyond = depth_of(old_point(i).position) - at;
    if (kind == EntryKind::outside) {
      hold(i, kind);
    } else if (kind == EntryKind::leaving || std::abs(beyond) <= point.state.radius) {
      leave(i);
    } else if (kind == EntryKind::going || beyond < 0 || !may_hide(old, i)) {
      go(i);
    } else {
      hide(i);
    }
  }
}

/// Nothing sure is measured there: of the points that were seen, one stands for the surface.
void Morph::hold_one(std::span<const std::uint32_t> old) {
  bool held = false;
  for (const std::uint32_t i : old) {
    const EntryKind kind = entries_[i].kind;
    const bool second = kind == EntryKind::live && std::exchange(held, true);
    if (kind == EntryKind::going) {
      go(i);
    } else if (kind == EntryKind::leaving || second) {
      leave(i);
    } else {
      hold(i, kind);
    }
  }
}

/// Along the camera's axis, m.
float Morph::depth_of(const Eigen::Vector3f& position) const {
  return turn_.col(2).dot(position - shift_);
}

/// A block remembers one hidden surface: the one that was hidden first. What moves before it leaves
/// no trail.
bool Morph::may_hide(std::span<const std::uint32_t> old, std::uint32_t i) const {
  if (entries_[i].kind == EntryKind::hidden) return true;
  const PointState point = old_point(i);
  return std::ranges::none_of(old, [&](std::uint32_t other) {
    return entries_[other].kind == EntryKind::hidden &&
           (old_point(other).position - point.position).norm() > point.radius;
  });
}

/// Which of the old points is seen again: the nearest within R, or within what noise explains; or
/// what has come along the ray as fast as things move. Tells how it was.
std::uint32_t Morph::partner_of(const FilteredDepth& depth, std::span<const std::uint32_t> old,
                                const Point& seen, PointState& before) const {
  constexpr float kDeviations2 = BlockSurface::kDeviations * BlockSurface::kDeviations;
  const float same2 = std::max(seen.state.radius * seen.state.radius, kDeviations2 * seen.variance);
  std::uint32_t partner = kNone;
  float nearest = std::numeric_limits<float>::infinity();
  for (const std::uint32_t i : old) {
    const EntryKind kind = entries_[i].kind;
    if (kind == EntryKind::leaving || kind == EntryKind::outside) continue;
    const PointState state = old_point(i);
    const float squared = (state.position - seen.state.position).squaredNorm();
    if (squared >= nearest) continue;
    if (squared > same2 && !may_move(depth, seen, i, state)) continue;
    nearest = squared;
    partner = i;
    before = state;
  }
  return partner;
}

void Morph::appear(const Point& point) {
  PointState from = point.state;
  PointState to = point.state;
  if (!still_) from.weight = 0;
  if (last_) {
    from.presence = 0;
    to.presence = std::min(1.0f, comes_);
  }
  const EdgePlane edge = new_edge();
  add(from, to, {edge, edge}, {place_, EntryKind::live, moment_.stamp, point.variance});
}

/// Of a time that something takes, s, how much a snapshot lasts.
float Morph::share_of(double time) const {
  return static_cast<float>(moment_.duration / time);
}

/// Nothing says that the point is gone, nothing that it is there.
void Morph::hold(std::uint32_t i, EntryKind kind) {
  const double confirmed = std::min(entries_[i].confirmed, moment_.stamp);  // stamps may go back
  const double unsure = moment_.stamp + moment_.duration - confirmed - options_.silence;
  const auto sure = static_cast<float>(std::clamp(1 - unsure / options_.fade, 0.0, 1.0));
  const PointState from = old_point(i);
  const float most = std::min(from.presence, sure);
  keep(i, from, std::max(most, from.presence - share_of(options_.fade)), kind, confirmed);
}

/// Something before it keeps it from being seen.
void Morph::hide(std::uint32_t i) {
  const PointState from = old_point(i);
  keep(i, from, from.presence - share_of(kHidden), EntryKind::hidden, moment_.stamp);
}

/// It has been seen through.
void Morph::go(std::uint32_t i) {
  if (ends_) return leave(i);
  const PointState from = old_point(i);
  keep(i, from, from.presence - share_of(kGoes), EntryKind::going, entries_[i].confirmed);
}

/// Stays where it is, and is as sure as that when the snapshot ends; what nobody is sure of leaves.
void Morph::keep(std::uint32_t i, const PointState& from, float presence, EntryKind kind,
                 double confirmed) {
  const bool unseen = kind != EntryKind::live;
  if (from.presence <= 0 || (unseen && ++held_ > order_.size())) return leave(i);
  PointState to = from;
  to.presence = std::clamp(presence, 0.0f, 1.0f);
  to.weight = last_->end_density_weights[i];
  const EdgePlane was = old_edge(i);
  EdgePlane edge = was;
  if (unseen && edge.share < 0) edge.share = 0;  // what it meets may not be there any more
  add(from, to, {was, edge}, {place_, kind, confirmed, entries_[i].variance});
}

void Morph::leave(std::uint32_t i) {
  const PointState from = old_point(i);
  if (from.weight <= kGone) return;
  PointState to = from;
  to.weight = 0;
  const EdgePlane edge = old_edge(i);
  add(from, to, {edge, edge}, {place_, EntryKind::leaving, entries_[i].confirmed});
}

}  // namespace palpate
