// Decides on the point that a frame shows at each block, and on the old ones there.
#include "stream/block_fates.hpp"

#include <algorithm>
#include <utility>

namespace palpate {
namespace {

// Share of the blocks around one that have to show the same surface; a line has 2 of 8 (derived).
constexpr float kVouch = 0.25f;

// Share of R^2: points whose squared distance is below it are within R, however it was rounded.
constexpr float kWithin2 = 0.98f;

}  // namespace

void BlockFates::settle(std::size_t begin, std::size_t end, SettledBlocks& to) const {
  to.advancing.clear();
  to.shown.clear();
  to.unseen.clear();
  for (std::size_t index = begin; index < end; index += kLanes) {
    const std::uint32_t first = index + kLanes <= end && !blocks_.hide(index)
                                    ? matches_.four_at(index)
                                    : BlockEntries::kNone;
    PointMotion4& motions = to.advancing.emplace_back();
    motions.index = static_cast<std::uint32_t>(index);
    const bool live = first != BlockEntries::kNone && are_live(first, motions);
    if (live && blocks_.keeps(index) && advance(first, motions)) continue;
    const SeenFour four = blocks_.four_at(index);
    if (live && update(four, motions)) continue;
    to.advancing.pop_back();
    for (int l = 0; l < kLanes && index + l < end; ++l) settle(four.lane(l), to);
  }
}

/// Are four points live, beside no edge? Returns where they are.
bool BlockFates::are_live(std::uint32_t first, PointMotion4& motions) const {
  bool live = true;
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    const Entry& entry = shown_.entries()[first + k];
    live = live & (entry.kind == EntryKind::live);
    motions.variance[k] = entry.variance;
  }
  if (!live || any(~load<Ints>(&shown_.edges()[first]))) return false;
  motions.from = shown_.four_at(first);
  return true;
}

/// Four points that the last frame showed, and of which this one shows the same, go on to where
/// they were going.
bool BlockFates::advance(std::uint32_t first, PointMotion4& motions) const {
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    if (shown_.entries()[first + k].confirmed != shown_.stamp()) return false;
  }
  motions.to = shown_.end_of_four(first);
  return all(motions.to.presence >= 1);
}

/// Are four live points seen again within R, as they face, beside no edge? Else there is more to
/// decide. Worth 16 to 29 % of a frame (bench/notes/2026-11-25-points-in-fours.md).
bool BlockFates::update(const SeenFour& seen, PointMotion4& motions) const {
  if (any(~seen.edges)) return false;
  const Vectors offset = motions.from.position - seen.position;
  const Vectors& normal = motions.from.normal;
  const Ints near =
      (seen.radius > 0) & (dot(offset, offset) <= kWithin2 * (seen.radius * seen.radius));
  const Ints turns = ~normal.zero() &
                     (dot(seen.normal, normal) < SeenPoint::kTurns * dot(seen.normal, seen.normal));
  if (!all(near & ~turns)) return false;
  moves_.update(seen, motions);
  return true;
}

/// Decides on the point that the frame has at a block, and on the old ones there.
void BlockFates::settle(const SeenPoint& seen, SettledBlocks& to) const {
  std::optional<BlockMatches::Partner> partner;
  if (seen.state.radius > 0) partner = matches_.partner_of(seen);
  const bool shown = seen.state.radius > 0 && is_confident(seen, partner);
  if (!shown) partner.reset();
  float at = blocks_.depth_of(seen.state.position);
  if (shown && !partner) add(moves_.appear(seen), seen, to);
  if (partner) {
    const auto& [i, before] = *partner;
    const bool vouched = !is_doubtful(seen, before);
    const Fate next = fate({.shown = true, .same = true, .vouched = vouched});
    if (next == Fate::confirm) at = blocks_.depth_of(before.position);
    add(next == Fate::update ? moves_.update(seen, i, before) : moves_.confirm(i, before), seen,
        to);
  }
  const std::span<const std::uint32_t> old = matches_.at(seen.index);
  const std::optional<std::uint32_t> own = partner ? std::optional(partner->i) : std::nullopt;
  const std::optional<std::uint32_t> behind = settle_behind(seen.index, own, to);
  bool held = false;
  for (const std::uint32_t i : old) {
    if (i == own || i == behind) continue;
    FateFacts facts{.kind = shown_.entries()[i].kind, .shown = shown};
    if (shown) {
      facts.beyond = blocks_.depth_of(shown_.at(i).position) - at;
      facts.radius = seen.state.radius;
      facts.may_hide = facts.beyond > facts.radius && may_hide(old, i);
    } else {
      facts.second = facts.kind == EntryKind::live && std::exchange(held, true);
    }
    add(moves_.unseen(fate(facts), i), seen, to);
  }
}

/// Lets a plane go on behind what the block shows, which is the old point `shown`, unless the block
/// remembers what was seen there, or what it shows comes from there.
/// @return the old point of that plane.
std::optional<std::uint32_t> BlockFates::settle_behind(std::uint32_t index,
                                                       std::optional<std::uint32_t> shown,
                                                       SettledBlocks& to) const {
  const SeenPoint behind = blocks_.behind(index);
  if (!(behind.state.radius > 0)) return {};
  std::optional<std::uint32_t> old;
  for (const std::uint32_t i : matches_.at(index)) {
    const EntryKind kind = shown_.entries()[i].kind;
    const float distance = (shown_.at(i).position - behind.state.position).norm();
    const bool same = distance <= behind.state.radius;
    if (kind == EntryKind::hidden || (kind == EntryKind::live && same)) return {};
    if (kind == EntryKind::supposed && same && i != shown) old = i;
  }
  PointMotion motion = old ? moves_.update(behind, *old, shown_.at(*old)) : moves_.appear(behind);
  motion.entry.kind = EntryKind::supposed;
  add(motion, behind, to);
  return old;
}

/// Is the surface that the block shows there, rather than a pixel between two surfaces or a normal
/// that noise has turned within a frame? One that turns for longer is believed after a while.
bool BlockFates::is_confident(const SeenPoint& seen,
                              const std::optional<BlockMatches::Partner>& partner) const {
  if (partner) return !(seen.turns_from(partner->before.normal) && moves_.is_fresh(partner->i));
  return !shown_.any() || blocks_.vouching(seen.index) >= kVouch;
}

/// Is the old point elsewhere than what is seen now, within noise, and hardly a block around it
/// shows that, too? Such a frame does not show where the surface is.
bool BlockFates::is_doubtful(const SeenPoint& seen, const PointState& before) const {
  return (before.position - seen.state.position).norm() > seen.state.radius &&
         blocks_.vouching(seen.index) < FrameBlocks::kVouchToMove;
}

/// A block remembers one hidden surface: the one that was hidden first. What moves before it leaves
/// no trail.
bool BlockFates::may_hide(std::span<const std::uint32_t> old, std::uint32_t i) const {
  const std::vector<Entry>& entries = shown_.entries();
  if (entries[i].kind == EntryKind::hidden) return true;
  const PointState point = shown_.at(i);
  return std::ranges::none_of(old, [&](std::uint32_t other) {
    return entries[other].kind == EntryKind::hidden &&
           (shown_.at(other).position - point.position).norm() > point.radius;
  });
}

void BlockFates::add(PointMotion motion, const SeenPoint& at, SettledBlocks& to) const {
  if (PointMoves::is_gone(motion)) return;
  motion.entry.index = at.index;
  motion.code = blocks_.order().codes[at.index];
  (motion.entry.kind == EntryKind::live ? to.shown : to.unseen).push_back(motion);
}

}  // namespace palpate
