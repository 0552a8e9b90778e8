// Chooses which blocks of a cloud are shown, and lists where nothing is.
#pragma once

#include <span>
#include <vector>

#include "large/block_supply.hpp"

namespace palpate {

/// The blocks around what tools can reach, and where there are none.
struct BlocksAround {
  double near;  ///< how far around what tools can reach nothing is to be missing, m
  std::vector<CloudBlock> blocks = {};
  std::vector<Box> unlisted = {};  ///< where no block is
  std::vector<Ball> tools = {};
  bool all_ready = false;  ///< of the blocks that are wanted

  /// Lists the blocks where tools are (at the cloud's start before there are any) and measures how
  /// far each is; `now`: s. Returns the share of the work that is done, 0 to 1.
  double look(BlockSupply& supply, double now);

  /// The nearest block that is missing, if one is nearer than `within`, m.
  [[nodiscard]] CloudBlock* nearest_missing(double within);
};

/// The blocks to show: all that tools can reach, and more while they are few, those within `near`
/// (m) of what tools can reach first.
[[nodiscard]] std::vector<CloudBlock*> choose_shown(std::span<CloudBlock> blocks, double near);

/// Is there a block near that is to be shown and is not yet? One for which there is no room does
/// not count: nobody is to wait for it.
[[nodiscard]] bool shows_more(std::span<CloudBlock> blocks, double near);

/// Where nothing is listed (`unlisted`) or shown, the nearest blocks first.
[[nodiscard]] std::vector<Box> missing_boxes(std::span<const CloudBlock> blocks,
                                             std::span<CloudBlock* const> shown,
                                             std::vector<Box> unlisted);

/// Was a box near `tools` reported as not loaded (`missing`), and is it not so any more? A block
/// may turn out to have no points there.
[[nodiscard]] bool has_filled(std::span<const Box> missing, std::span<CloudBlock> blocks,
                              const std::vector<Box>& unlisted, std::span<const Ball> tools,
                              double near);

}  // namespace palpate
