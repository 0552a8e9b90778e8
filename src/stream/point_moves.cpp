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

// A block is much less certain than the prior from this ratio of variances on, and agrees with
// it within so many deviations of the difference.
constexpr float kUncertain = 4;
constexpr float kAgree = 5;  // judgement, both (docs/method.md 7.3)

// How far along its normal a point goes to where it is seen, as a share: a block that is much less
// certain than the prior, as beside what begins to hide it or when it is seen again, counts for
// as much less while the two agree (the gain of a Kalman filter).
float gain_of(const SeenPoint& seen, float prior, float advance) {
  const float both = prior + seen.variance;
  const bool uncertain = seen.variance > kUncertain * prior;
  return uncertain && advance * advance < kAgree * kAgree * both ? prior / both : 1;
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

PointMotion PointMoves::appear(const SeenPoint& seen) const {
  PointState from = seen.state;
  PointState to = seen.state;
  if (!still_) from.weight = 0;
  if (shown_.any()) {
    from.presence = 0;
    to.presence = std::min(1.0f, comes_);
  }
  const SurfacePoints::EdgePlane edge = blocks_.edge_of(seen);
  return {from, to, EdgeMotion{edge, edge}, seen_entry(seen.variance)};
}

PointMotion PointMoves::update(const SeenPoint& seen, std::uint32_t i,
                               const PointState& from) const {
  PointState to = seen.state;
  const float prior = shown_.entries()[i].variance * doubt_;
  const float apart = (to.position - from.position).dot(to.normal);
  const float gain = gain_of(seen, prior, apart);
  to.position -= (1 - gain) * apart * to.normal;
  const Eigen::Vector3f offset = to.position - from.position;
  if (offset.squaredNorm() > to.radius * to.radius) {
    const float fastest = shown_.speed_of(i) + ShownPoints::kSudden;
    const float most = fastest * static_cast<float>(moment_.duration);
    const float advance = std::max(seen.advance_from(from.position), to.radius);
    to.position = from.position + std::min(1.0f, std::max(most, to.radius) / advance) * offset;
  }
  to.radius = from.radius + kShare * (to.radius - from.radius);
  to.confidence = from.confidence + kShare * (to.confidence - from.confidence);
  to.weight = seen.weight(to.radius);
  if (to.normal.isZero(0)) to.normal = from.normal;
  to.presence = std::min(1.0f, from.presence + comes_);
  return {from, to, edge_of(seen, i), seen_entry(gain < 1 ? prior : seen.variance)};
}

void PointMoves::update(const SeenFour& seen, PointMotion4& motions) const {
  const Floats whole = Floats{} + 1.0f;
  const PointStates& from = motions.from;
  const Floats prior = motions.variance * doubt_;
  const Floats both = prior + seen.variance;
  const Floats apart = dot(seen.position - from.position, seen.normal);
  const Ints uncertain =
      (seen.variance > kUncertain * prior) & (apart * apart < kAgree * kAgree * both);
  const Floats gain = uncertain ? prior / both : whole;
  motions.variance = gain < 1 ? prior : seen.variance;
  motions.to.position = seen.position - ((1 - gain) * apart) * seen.normal;
  motions.to.normal = choose(seen.normal.zero(), from.normal, seen.normal);
  motions.to.radius = from.radius + kShare * (seen.radius - from.radius);
  motions.to.confidence = from.confidence + kShare * (seen.confidence - from.confidence);
  motions.to.weight =
      seen.trust * least(whole, seen.area / (motions.to.radius * motions.to.radius));
  motions.to.presence = least(whole, from.presence + comes_);
}

/// The edge of an old point that is seen again. Most have none.
EdgeMotion PointMoves::edge_of(const SeenPoint& seen, std::uint32_t i) const {
  const bool was_beside = shown_.edges()[i] != SurfacePoints::Edges::kNone;
  if (seen.edge == EdgeFinder::kNone && !was_beside) return {};
  const SurfacePoints::EdgePlane was = shown_.edge_of(i);
  SurfacePoints::EdgePlane edge = blocks_.edge_of(seen);
  const float share = was.share + kShare * (edge.share - was.share);
  if (edge.share == 0) edge = was;
  edge.share = std::abs(share) > kLeastShare ? share : 0;
  return {was, edge};
}

PointMotion PointMoves::confirm(std::uint32_t i, const PointState& from) const {
  return retained(i, from, from.presence + comes_, EntryKind::live, moment_.stamp);
}

PointMotion PointMoves::unseen(Fate fate, std::uint32_t i) const {
  switch (fate) {
    case Fate::go:
      return fade(i);
    case Fate::hide:
      return hide(i);
    case Fate::retain:
      return retain(i);
    case Fate::update:
    case Fate::confirm:  // of points that a block shows
    case Fate::remove:
      break;
  }
  return remove(i);
}

/// Keeps a point of which nothing shows whether it is gone or there.
PointMotion PointMoves::retain(std::uint32_t i) const {
  const Entry& entry = shown_.entries()[i];
  // Stamps may go back.
  const double confirmed = std::min(entry.confirmed, moment_.stamp);
  const double uncertain = moment_.stamp + moment_.duration - confirmed - options_.silence;
  const auto confidence = static_cast<float>(std::clamp(1 - uncertain / options_.fade, 0.0, 1.0));
  const PointState from = shown_.at(i);
  const float most = std::min(from.presence, confidence);
  const float presence = std::max(most, from.presence - share_of(options_.fade));
  return retained(i, from, presence, entry.kind, confirmed);
}

/// Keeps a point that something nearer hides.
PointMotion PointMoves::hide(std::uint32_t i) const {
  const PointState from = shown_.at(i);
  return retained(i, from, from.presence - share_of(kHidden), EntryKind::hidden, moment_.stamp);
}

/// Lets a point fade that was seen through.
PointMotion PointMoves::fade(std::uint32_t i) const {
  if (ends_) return remove(i);
  const PointState from = shown_.at(i);
  const float presence = from.presence - share_of(kGoes);
  return retained(i, from, presence, EntryKind::going, shown_.entries()[i].confirmed);
}

/// Keeps a point where it is and takes its presence to `presence` while the snapshot lasts; one
/// that has none leaves.
PointMotion PointMoves::retained(std::uint32_t i, const PointState& from, float presence,
                                 EntryKind kind, double confirmed) const {
  if (from.presence <= 0) return remove(i);
  PointState to = from;
  to.presence = std::clamp(presence, 0.0f, 1.0f);
  to.weight = shown_.end_weight(i);
  const SurfacePoints::EdgePlane was = shown_.edge_of(i);
  SurfacePoints::EdgePlane edge = was;
  // What a crease meets may not be there any more.
  if (kind != EntryKind::live && edge.share < 0) edge.share = 0;
  return {from,
          to,
          EdgeMotion{was, edge},
          Entry{confirmed, shown_.entries()[i].variance, 0, kind},
          0,
          shown_.to_eye(i)};
}

PointMotion PointMoves::remove(std::uint32_t i) const {
  const PointState from = shown_.at(i);
  PointMotion motion{from, from, {shown_.edge_of(i), {}}, shown_.entries()[i], 0, shown_.to_eye(i)};
  remove(motion);
  return motion;
}

void PointMoves::remove(PointMotion& motion) {
  motion.to = motion.from;
  motion.to.weight = 0;
  motion.edge.end = motion.edge.start;
  motion.entry.kind = EntryKind::removed;
}

bool PointMoves::is_gone(const PointMotion& motion) {
  return motion.entry.kind == EntryKind::removed && motion.from.weight <= kGone;
}

}  // namespace palpate
