// The third step of prepare(): the support radius of each point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/sampling.hpp"

namespace palpate {

inline constexpr float kUsualMultiple = 2.5f;  ///< m in R = m s: the paper's (section V)

/// The support radii.
struct Radii {
  std::vector<float> values;           ///< R_i in sorted order, m
  std::vector<std::uint8_t> outliers;  ///< 1: an outlier, whose R is small unless one is given;
                                       ///< empty: nobody looked for them
};

/// The largest R that a point may have, m: 12 of the typical ones by the facts, since a block looks
/// no farther around itself (Blocks::halo). Infinite where they have none.
[[nodiscard]] double largest_radius(const CloudFacts& facts);

/// R = m s and more where there is noise (docs/method.md 5.3); one R for all where the options
/// demand so.
[[nodiscard]] Radii choose_radii(const Sampling& sampling, const PrepareOptions& options);

/// Support radii for a noisy cloud: at each point so large that noise tilts normals by
/// `normal_error` (rad), and at least four sigma, nowhere below a point's of `floors` nor above
/// 2.4 times that. All in sorted order, m.
[[nodiscard]] std::vector<float> noisy_radii(const CellGrid& grid, const LocalNoise& noise,
                                             double normal_error, std::vector<float> floors);

/// Makes support radii smaller again, by a quarter at most, where the points within them curve away
/// from a plane by more than noise explains: at edges, which a large R rounds off by about 0.35 R
/// (docs/method.md 5.3), a little noise is the smaller evil. Part of noisy_radii().
void shrink_at_edges(const CellGrid& grid, const std::vector<float>& floors,
                     std::vector<float>& radii);

}  // namespace palpate
