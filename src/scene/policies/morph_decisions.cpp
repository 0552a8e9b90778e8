// Gathers the facts on which the fate of each point depends, and moves it accordingly.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/policies/morph.hpp"

namespace palpate {
namespace {

// Share of the blocks around one that have to show the same surface; a line has 2 of 8 (derived).
constexpr float kVouch = 0.25f;

// A weight below this is gone (judgement: far below what a force resolves).
constexpr float kGone = 1e-4f;

// Fade times, s. Surfaces seen through: 5 x EnergyTank::kTime, so that the spring can follow.
// Hidden surfaces: slow, but not forever, as what hides them may carry them off.
constexpr double kGoes = 0.1;   // derived
constexpr double kHidden = 60;  // judgement (docs/method.md 7.3)

}  // namespace

/// Decides on the point that the frame has at a block, and on the old ones there.
void Morph::settle(const FilteredDepth& depth, const Point& point, Piece& to) const {
  const std::span<const std::uint32_t> old = by_block_.at(point.place);
  PointState before;
  std::uint32_t partner =
      point.state.radius > 0 ? partner_of(depth, old, point, before) : std::uint32_t{kNone};
  const bool shown = point.state.radius > 0 && is_sure(depth, point, partner, before);
  if (!shown) partner = kNone;
  float at = depth_of(point.state.position);
  if (shown && partner == kNone) add(appear(point), point, to);
  if (partner != kNone) {
    const bool vouched = !stays(depth, point, before);
    const Fate own = fate({.shown = true, .same = true, .vouched = vouched});
    if (own == Fate::stay) at = depth_of(before.position);
    const float presence = before.presence + comes_;
    add(own == Fate::follow ? follow(point, partner, before)
                            : keep(partner, before, presence, EntryKind::live, moment_.stamp),
        point, to);
  }
  bool held = false;
  for (const std::uint32_t i : old) {
    if (i == partner) continue;
    FateFacts facts{.kind = entries_[i].kind, .shown = shown};
    if (shown) {
      facts.beyond = depth_of(old_point(i).position) - at;
      facts.radius = point.state.radius;
      facts.may_hide = facts.beyond > facts.radius && may_hide(old, i);
    } else {
      facts.second = facts.kind == EntryKind::live && std::exchange(held, true);
    }
    add(way_of(fate(facts), i), point, to);
  }
}

/// Is the surface that the block shows there, rather than a pixel between two surfaces or a normal
/// that noise has turned?
bool Morph::is_sure(const FilteredDepth& depth, const Point& point, std::uint32_t partner,
                    const PointState& before) const {
  if (partner != kNone) return !turns_away(point, partner, before);
  return !last_ || beside(depth, order_.blocks[point.place]) >= kVouch;
}

/// `fate`: of a point that is not seen again.
Way Morph::way_of(Fate fate, std::uint32_t i) const {
  switch (fate) {
    case Fate::go:
      return go(i);
    case Fate::hide:
      return hide(i);
    case Fate::hold:
      return hold(i, entries_[i].kind);
    default:
      return leave(i);
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
  // Squared, since a variance is compared with a squared distance.
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

Way Morph::appear(const Point& point) const {
  PointState from = point.state;
  PointState to = point.state;
  if (!still_) from.weight = 0;
  if (last_) {
    from.presence = 0;
    to.presence = std::min(1.0f, comes_);
  }
  const SurfacePoints::EdgePlane edge = new_edge(point);
  return {from, to, EdgeWay{edge, edge}, Entry{moment_.stamp, point.variance}};
}

/// The snapshot's duration as a share of `time`, s.
float Morph::share_of(double time) const {
  return static_cast<float>(moment_.duration / time);
}

/// Nothing says that the point is gone, nothing that it is there.
Way Morph::hold(std::uint32_t i, EntryKind kind) const {
  const double confirmed = std::min(entries_[i].confirmed, moment_.stamp);  // stamps may go back
  const double unsure = moment_.stamp + moment_.duration - confirmed - options_.silence;
  const auto sure = static_cast<float>(std::clamp(1 - unsure / options_.fade, 0.0, 1.0));
  const PointState from = old_point(i);
  const float most = std::min(from.presence, sure);
  const float presence = std::max(most, from.presence - share_of(options_.fade));
  return keep(i, from, presence, kind, confirmed);
}

/// Something before it keeps it from being seen.
Way Morph::hide(std::uint32_t i) const {
  const PointState from = old_point(i);
  return keep(i, from, from.presence - share_of(kHidden), EntryKind::hidden, moment_.stamp);
}

/// It has been seen through.
Way Morph::go(std::uint32_t i) const {
  if (ends_) return leave(i);
  const PointState from = old_point(i);
  const float presence = from.presence - share_of(kGoes);
  return keep(i, from, presence, EntryKind::going, entries_[i].confirmed);
}

/// Stays where it is, and is as sure as that when the snapshot ends; what nobody is sure of leaves.
Way Morph::keep(std::uint32_t i, const PointState& from, float presence, EntryKind kind,
                double confirmed) const {
  if (from.presence <= 0) return leave(i);
  PointState to = from;
  to.presence = std::clamp(presence, 0.0f, 1.0f);
  to.weight = last_->end_density_weights[i];
  const SurfacePoints::EdgePlane was = old_edge(i);
  SurfacePoints::EdgePlane edge = was;
  if (kind != EntryKind::live && edge.share < 0)
    edge.share = 0;  // what it meets may not be there any more
  return {from, to, EdgeWay{was, edge}, Entry{confirmed, entries_[i].variance, 0, kind}};
}

Way Morph::leave(std::uint32_t i) const {
  const PointState from = old_point(i);
  Way way{from, from, {old_edge(i), {}}, entries_[i]};
  leave(way);
  return way;
}

void Morph::leave(Way& way) {
  way.to = way.from;
  way.to.weight = 0;
  way.edge.end = way.edge.start;
  way.entry.kind = EntryKind::leaving;
}

void Morph::add(Way way, const Point& at, Piece& to) const {
  if (way.entry.kind == EntryKind::leaving && way.from.weight <= kGone) return;
  way.entry.place = at.place;
  way.code = order_.codes[at.place];
  (way.entry.kind == EntryKind::live ? to.shown : to.unseen).push_back(way);
}

/// No more of them than there are blocks: what comes later leaves.
void Morph::gather_unseen(const Piece& piece) {
  for (Way way : piece.unseen) {
    const bool held = way.entry.kind != EntryKind::leaving && ++held_ > order_.size();
    if (held) leave(way);
    if (!held || way.from.weight > kGone) unseen_.push_back(way);
  }
}

}  // namespace palpate
