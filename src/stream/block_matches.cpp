// Matches the blocks of a frame with the points that were shown last.
#include "stream/block_matches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr float kBeside = 0.5f;  // R by which depths of one surface differ from block to block

// A surface that rested and moves faster than this along its normal is taken for another one, m/s
// (judgement; docs/method.md 7.3).
constexpr float kFastest = 1;

}  // namespace

void BlockEntries::sort(std::span<const Entry> entries, std::size_t blocks) {
  begin_.resize(blocks + 2);
  std::fill(begin_.begin(), begin_.end(), 0u);
  for (const Entry& entry : entries) ++begin_[entry.index + 2];
  for (std::size_t index = 2; index < begin_.size(); ++index) begin_[index] += begin_[index - 1];
  sorted_.resize(entries.size());
  // begin_[index + 1] runs from where the index's entries begin to where they end.
  for (std::size_t i = 0; i < entries.size(); ++i) {
    sorted_[begin_[entries[i].index + 1]++] = static_cast<std::uint32_t>(i);
  }
}

void BlockMatches::begin(bool moved, const Pinhole& pinhole, double duration) {
  moved_ = moved;
  duration_ = static_cast<float>(duration);
  if (moved) follow_camera(pinhole);
  if (moved || !listed_) by_block_.sort(shown_.entries(), blocks_.order().size());
  listed_ = false;
}

void BlockMatches::end(std::span<const Entry> entries) {
  if (moved_) return;  // and will move on
  by_block_.sort(entries, blocks_.order().size());
  listed_ = true;
}

/// Puts every old point at the block that sees it now.
void BlockMatches::follow_camera(const Pinhole& pinhole) {
  const auto last = static_cast<std::uint32_t>(blocks_.order().size() - 1);
  std::uint32_t i = 0;
  for (Entry& entry : shown_.entries()) {
    const std::uint32_t index = blocks_.index_of(shown_.at(i++).position, pinhole);
    if (index != FrameBlocks::kNone) {
      entry.index = index;
      if (entry.kind == EntryKind::out_of_range) entry.kind = EntryKind::live;
    } else {
      const bool stays = entry.kind == EntryKind::live || entry.kind == EntryKind::hidden;
      if (stays) entry.kind = EntryKind::out_of_range;
      if (entry.kind == EntryKind::supposed) entry.kind = EntryKind::going;
      entry.index = std::min<std::uint32_t>(entry.index, last);
    }
  }
}

std::optional<BlockMatches::Partner> BlockMatches::partner_of(const SeenPoint& seen) const {
  // Squared, since a variance is compared with a squared distance.
  constexpr float kDeviations2 = BlockSurface::kDeviations * BlockSurface::kDeviations;
  const float same2 = std::max(seen.state.radius * seen.state.radius, kDeviations2 * seen.variance);
  std::optional<Partner> partner;
  float nearest = std::numeric_limits<float>::infinity();
  for (const std::uint32_t i : at(seen.index)) {
    const EntryKind kind = shown_.entries()[i].kind;
    if (kind == EntryKind::removed || kind == EntryKind::out_of_range) continue;
    const PointState state = shown_.at(i);
    const float squared = (state.position - seen.state.position).squaredNorm();
    if (squared >= nearest) continue;
    if (squared > same2 && !may_move(seen, i, state)) continue;
    nearest = squared;
    partner = Partner{i, state};
  }
  return partner;
}

/// Has what was there come along the ray to what is seen now?
bool BlockMatches::may_move(const SeenPoint& seen, std::uint32_t i,
                            const PointState& before) const {
  if (shown_.entries()[i].kind != EntryKind::live || moved_) return false;
  const float went_on = std::min(shown_.speed_of(i), ShownPoints::kSudden) * duration_;
  // The longer nothing was seen, the likelier what is nearer now is something else.
  const float sped_up = kFastest * std::min(duration_, static_cast<float>(kUsualInterval));
  return !seen.turns_from(before.normal) &&
         seen.advance_from(before.position) <= sped_up + went_on &&
         blocks_.vouching(seen.index) >= FrameBlocks::kVouchToMove && !came_aside(seen);
}

/// Was what a block shows now beside it before? Then the rim of something moved, or is noisy.
bool BlockMatches::came_aside(const SeenPoint& seen) const {
  const BlockOrder& order = blocks_.order();
  bool found = false;
  visit_beside(order.columns, order.rows, order.blocks[seen.index], [&](std::size_t other) {
    for (const std::uint32_t i : at(order.indices[other])) {
      const float apart =
          blocks_.depth_of(shown_.at(i).position) - blocks_.depth_of(seen.state.position);
      const bool same = std::abs(apart) < kBeside * seen.state.radius;
      found = found || (same && shown_.entries()[i].kind == EntryKind::live);
    }
  });
  return found;
}

}  // namespace palpate
