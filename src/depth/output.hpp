#pragma once

#include "depth/block_fits.hpp"

namespace palpate::depth {

/// Makes room for one entry a block.
void resize(const BlockGrid& grid, FilteredDepth& out);

/// Places, normals, deviations and spacings from the fits. Leaves the rest of `out` alone.
void write_points(const BlockFits& fits, FilteredDepth& out);

}  // namespace palpate::depth
