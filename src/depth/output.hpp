#pragma once

#include "depth/blocks.hpp"

namespace palpate::depth {

/// Makes room for one entry a block.
void resize(const BlockGrid& grid, FilteredDepth& out);

/// Depths that can be believed, m.
struct DepthRange {
  double nearest = 0;
  double farthest = 0;
};

/// States, places, normals, deviations and spacings from the fits. A block that a fit puts clearly
/// out of range, or behind the camera, is empty. Leaves the rest of `out` alone.
void write_points(const BlockFits& fits, const DepthRange& range, FilteredDepth& out);

}  // namespace palpate::depth
