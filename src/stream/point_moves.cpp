// Moves each point by its fate.
#include "stream/point_moves.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Fade times, s. Surfaces seen through: 5 x EnergyTank::kTime, so that the spring can follow.
// Hidden surfaces: slow, but not forever, as what hides them may carry them off.
constexpr double kGoes = 0.1;   // derived
constexpr double kHidden = 60;  // judgement (docs/method.md 7.3)

// A weight below this is gone (judgement: far below what a force resolves).
constexpr float kGone = 1e-4f;

constexpr float kLeastShare = 0.01f;  // of an edge; with less it is none

// Share by which a point's radius, confidence and edge follow a frame (docs/method.md 7.3).
constexpr float kShare = 0.25f;

// A block is much less certain than what is known from this ratio of variances on, and agrees with
// it within so many deviations of the difference.
constexpr float kUncertain = 4;
constexpr float kAgree = 5;  // judgement, both (docs/method.md 7.3)

// How far along its normal a point goes to where it is seen, as a share: a block that is much less
// sure than what is known, as beside what begins to hide it or when it is seen again, counts for
// as much less while the two agree (the gain of a Kalman filter).
float gain_of(const SeenPoint& seen, float known, float advance) {
  const float both = known + seen.variance;
  const bool uncertain = seen.variance > kUncertain * known;
  return uncertain && advance * advance < kAgree * kAgree * both ? known / both : 1;
}

}  // namespace

void PointMoves::begin(const FrameTiming& moment, bool last, bool still) {
  moment_ = moment;
  ends_ = last;
  still_ = still;
  comes_ = last ? 1 : share_of(options_.fade);
  doubt_ = std::exp(share_of(options_.fade));
}

/// The snapshot's duration as a share of `time`, s.
float PointMoves::share_of(double time) const {
  return static_cast<float>(moment_.duration / time);
}

bool PointMoves::is_fresh(std::uint32_t i) const {
  return moment_.stamp - shown_.entries()[i].confirmed < options_.silence;
}

Way PointMoves::appear(const SeenPoint& seen) const {
  PointState from = seen.state;
  PointState to = seen.state;
  if (!still_) from.weight = 0;
  if (shown_.any()) {
    from.presence = 0;
    to.presence = std::min(1.0f, comes_);
  }
  const SurfacePoints::EdgePlane edge = blocks_.edge_of(seen);
  return {from, to, EdgeWay{edge, edge}, seen_entry(seen.variance)};
}

Way PointMoves::follow(const SeenPoint& seen, std::uint32_t i, const PointState& from) const {
  PointState to = seen.state;
  const float known = shown_.entries()[i].variance * doubt_;
  const float apart = (to.position - from.position).dot(to.normal);
  const float gain = gain_of(seen, known, apart);
  to.position -= (1 - gain) * apart * to.normal;
  const Eigen::Vector3f way = to.position - from.position;
  if (way.squaredNorm() > to.radius * to.radius) {
    const float fastest = shown_.speed_of(i) + ShownPoints::kSudden;
    const float most = fastest * static_cast<float>(moment_.duration);
    const float advance = std::max(seen.advance_from(from.position), to.radius);
    to.position = from.position + std::min(1.0f, std::max(most, to.radius) / advance) * way;
  }
  to.radius = from.radius + kShare * (to.radius - from.radius);
  to.confidence = from.confidence + kShare * (to.confidence - from.confidence);
  to.weight = seen.weight(to.radius);
  if (to.normal.isZero(0)) to.normal = from.normal;
  to.presence = std::min(1.0f, from.presence + comes_);
  return {from, to, edge_of(seen, i), seen_entry(gain < 1 ? known : seen.variance)};
}

void PointMoves::follow(const SeenFour& seen, FourWays& ways) const {
  const Floats whole = Floats{} + 1.0f;
  const PointStates& from = ways.from;
  const Floats known = ways.variance * doubt_;
  const Floats both = known + seen.variance;
  const Floats apart = dot(seen.position - from.position, seen.normal);
  const Ints uncertain =
      (seen.variance > kUncertain * known) & (apart * apart < kAgree * kAgree * both);
  const Floats gain = uncertain ? known / both : whole;
  ways.variance = gain < 1 ? known : seen.variance;
  ways.to.position = seen.position - ((1 - gain) * apart) * seen.normal;
  ways.to.normal = choose(seen.normal.zero(), from.normal, seen.normal);
  ways.to.radius = from.radius + kShare * (seen.radius - from.radius);
  ways.to.confidence = from.confidence + kShare * (seen.confidence - from.confidence);
  ways.to.weight = seen.trust * least(whole, seen.area / (ways.to.radius * ways.to.radius));
  ways.to.presence = least(whole, from.presence + comes_);
}

/// The edge of an old point that is seen again. Most have none.
EdgeWay PointMoves::edge_of(const SeenPoint& seen, std::uint32_t i) const {
  const bool was_beside = shown_.edges()[i] != SurfacePoints::Edges::kNone;
  if (seen.edge == EdgeFinder::kNone && !was_beside) return {};
  const SurfacePoints::EdgePlane was = shown_.edge_of(i);
  SurfacePoints::EdgePlane edge = blocks_.edge_of(seen);
  const float share = was.share + kShare * (edge.share - was.share);
  if (edge.share == 0) edge = was;
  edge.share = std::abs(share) > kLeastShare ? share : 0;
  return {was, edge};
}

Way PointMoves::stay(std::uint32_t i, const PointState& from) const {
  return keep(i, from, from.presence + comes_, EntryKind::live, moment_.stamp);
}

Way PointMoves::unseen(Fate fate, std::uint32_t i) const {
  switch (fate) {
    case Fate::go:
      return go(i);
    case Fate::hide:
      return hide(i);
    case Fate::hold:
      return hold(i);
    case Fate::follow:
    case Fate::stay:  // of points that a block shows
    case Fate::leave:
      break;
  }
  return leave(i);
}

/// Keeps a point of which nothing shows whether it is gone or there.
Way PointMoves::hold(std::uint32_t i) const {
  const Entry& entry = shown_.entries()[i];
  // Stamps may go back.
  const double confirmed = std::min(entry.confirmed, moment_.stamp);
  const double uncertain = moment_.stamp + moment_.duration - confirmed - options_.silence;
  const auto sure = static_cast<float>(std::clamp(1 - uncertain / options_.fade, 0.0, 1.0));
  const PointState from = shown_.at(i);
  const float most = std::min(from.presence, sure);
  const float presence = std::max(most, from.presence - share_of(options_.fade));
  return keep(i, from, presence, entry.kind, confirmed);
}

/// Keeps a point that something nearer hides.
Way PointMoves::hide(std::uint32_t i) const {
  const PointState from = shown_.at(i);
  return keep(i, from, from.presence - share_of(kHidden), EntryKind::hidden, moment_.stamp);
}

/// Lets a point fade that was seen through.
Way PointMoves::go(std::uint32_t i) const {
  if (ends_) return leave(i);
  const PointState from = shown_.at(i);
  const float presence = from.presence - share_of(kGoes);
  return keep(i, from, presence, EntryKind::going, shown_.entries()[i].confirmed);
}

/// Keeps a point where it is and takes its presence to `presence` while the snapshot lasts; one
/// that has none leaves.
Way PointMoves::keep(std::uint32_t i, const PointState& from, float presence, EntryKind kind,
                     double confirmed) const {
  if (from.presence <= 0) return leave(i);
  PointState to = from;
  to.presence = std::clamp(presence, 0.0f, 1.0f);
  to.weight = shown_.end_weight(i);
  const SurfacePoints::EdgePlane was = shown_.edge_of(i);
  SurfacePoints::EdgePlane edge = was;
  // What a crease meets may not be there any more.
  if (kind != EntryKind::live && edge.share < 0) edge.share = 0;
  return {from,
          to,
          EdgeWay{was, edge},
          Entry{confirmed, shown_.entries()[i].variance, 0, kind},
          0,
          shown_.to_eye(i)};
}

Way PointMoves::leave(std::uint32_t i) const {
  const PointState from = shown_.at(i);
  Way way{from, from, {shown_.edge_of(i), {}}, shown_.entries()[i], 0, shown_.to_eye(i)};
  leave(way);
  return way;
}

void PointMoves::leave(Way& way) {
  way.to = way.from;
  way.to.weight = 0;
  way.edge.end = way.edge.start;
  way.entry.kind = EntryKind::leaving;
}

bool PointMoves::is_gone(const Way& way) {
  return way.entry.kind == EntryKind::leaving && way.from.weight <= kGone;
}

}  // namespace palpate
