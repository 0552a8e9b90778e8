#pragma once

#include "depth/block_fits.hpp"
#include "depth/neighbors.hpp"

namespace palpate::depth {

/// A plane through what shows the block's surface among the 5x5 blocks around it: where no whole
/// window fits. Writes the block's columns.
void fit_masked(const Blocks& blocks, const SameSurface& same, int column, int row,
                BlockFits& fits);

}  // namespace palpate::depth
