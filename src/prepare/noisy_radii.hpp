#pragma once

#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "prepare/noise_map.hpp"

namespace palpate {

/// Support radii for a noisy cloud: from place to place so large that noise tilts normals by
/// `normal_error` (rad), nowhere below a point's `floor` nor above 2.4 times that. `excess`:
/// Noise::excess. All in sorted order, m.
[[nodiscard]] std::vector<float> noisy_radii(const CellGrid& grid, const NoiseMap& noise,
                                             double excess, double normal_error,
                                             const std::vector<float>& floors);

/// Makes support radii smaller again, by a quarter at most, where the points within them bend away
/// from a plane by more than noise explains: at edges, which a large R rounds off by about 0.35 R
/// (field_choice.md section 5), a little noise is the smaller evil. Part of noisy_radii().
void shrink_at_edges(const CellGrid& grid, const std::vector<float>& floors,
                     std::vector<float>& radii);

}  // namespace palpate
