// Declares what becomes of the points at each block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stream/block_matches.hpp"
#include "stream/fate.hpp"
#include "stream/frame_blocks.hpp"
#include "stream/moving_points.hpp"
#include "stream/point_moves.hpp"
#include "stream/shown_points.hpp"

namespace palpate {

/// What becomes of the points of some blocks, in the order of the curve.
struct SettledBlocks {
  std::vector<PointMotion4> advancing;
  std::vector<PointMotion> shown;   ///< of blocks where there is more to decide, in order
  std::vector<PointMotion> unseen;  ///< points that no block shows

  /// How many points blocks show.
  [[nodiscard]] std::size_t count() const { return kLanes * advancing.size() + shown.size(); }
};

/// Gathers the facts on which the fate of each point depends, and has it moved accordingly.
class BlockFates {
 public:
  /// All have to last as long.
  BlockFates(const ShownPoints& shown, const FrameBlocks& blocks, const BlockMatches& matches,
             const PointMoves& moves)
      : shown_(shown), blocks_(blocks), matches_(matches), moves_(moves) {}

  /// Decides on the blocks from `begin` to `end` of the curve. Any number of threads, each with its
  /// own `to`.
  void settle(std::size_t begin, std::size_t end, SettledBlocks& to) const;

 private:
  [[nodiscard]] bool are_live(std::uint32_t first, PointMotion4& motions) const;
  [[nodiscard]] bool advance(std::uint32_t first, PointMotion4& motions) const;
  [[nodiscard]] bool update(const SeenFour& seen, PointMotion4& motions) const;
  void settle(const SeenPoint& seen, SettledBlocks& to) const;
  [[nodiscard]] std::optional<std::uint32_t> settle_behind(std::uint32_t index,
                                                           std::optional<std::uint32_t> shown,
                                                           SettledBlocks& to) const;
  [[nodiscard]] bool is_confident(const SeenPoint& seen,
                                  const std::optional<BlockMatches::Partner>& partner) const;
  [[nodiscard]] bool is_doubtful(const SeenPoint& seen, const PointState& before) const;
  [[nodiscard]] bool may_hide(std::span<const std::uint32_t> old, std::uint32_t i) const;
  void add(PointMotion motion, const SeenPoint& at, SettledBlocks& to) const;

  const ShownPoints& shown_;
  const FrameBlocks& blocks_;
  const BlockMatches& matches_;
  const PointMoves& moves_;
};

}  // namespace palpate
