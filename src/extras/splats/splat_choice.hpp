// Chooses the splats that a surface is made of, and the size of its cells.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "extras/splats/splat_cells.hpp"

namespace palpate::detail {

/// The splats of a scene that its surface is made of.
struct SplatChoice {
  SplatGrid grid;             ///< of edge 0 where no splat is opaque or has an extent
  std::vector<Splat> splats;  ///< in the order of the scene, without what cannot be seen
  std::size_t far = 0;        ///< left out, as the grid does not reach to their middles
  std::size_t huge = 0;       ///< left out, as they are the largest and their samples too many
  std::size_t samples = 0;    ///< that those kept take
};

/// Takes as cells' edge the size below which splats have half of all opacity, and as many splats as
/// kUsualSamples of each allow, the smallest first. The grid becomes coarser where less than half
/// of the opacity would be left.
[[nodiscard]] SplatChoice choose_splats(std::span<const Splat> splats);

}  // namespace palpate::detail
