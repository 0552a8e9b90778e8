#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/weight_sums.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// How far a point's nearest other is, in spacings: the median over a sample of the points. 1 on a
/// square grid, 0.9 where each is off its place by up to a tenth of the spacing, 0.5 where points
/// lie anywhere (Clark and Evans 1954). 1 where there are too few points to tell. `spacings`: those
/// of the points, in sorted order, m.
[[nodiscard]] double nearest_share(const CellGrid& grid, std::span<const float> spacings);

/// Do the points lie so irregularly that the gaps between them need a larger support?
[[nodiscard]] bool is_irregular(const CellGrid& grid, std::span<const float> spacings);

/// How noisy a cloud is where: sensors err more on what is far away or faces them.
class NoiseMap {
 public:
  /// `raw`: the points as measured, `spacings` theirs, in sorted order, m.
  NoiseMap(const CellGrid& raw, std::span<const float> spacings);

  /// sigma_n delta for each of `points`, m^2: rms distance from a smooth surface times the root of
  /// the area per point, as the flatter part of the surroundings has it, so that edges are no
  /// noise.
  [[nodiscard]] std::vector<float> at(std::span<const Eigen::Vector3f> points) const;

 private:
  CellGrid places_;
  std::vector<float> values_;  // sigma_n delta, in the order of places_
  float reach_ = 0;            // how far a value is of interest, m
  float typical_ = 0;
};

/// Support radii for a noisy cloud: from place to place so large that noise tilts normals by
/// `normal_error` (rad), nowhere below a point's `floor` nor above 2.4 times that. `excess`:
/// Noise::excess. All in sorted order, m.
[[nodiscard]] std::vector<float> noisy_radii(const CellGrid& grid, const NoiseMap& noise,
                                             double excess, double normal_error,
                                             const std::vector<float>& floors);

/// Makes support radii smaller again, by a quarter at most, where the points within them bend away
/// from a plane by more than noise explains: at edges, which a large R rounds off by about 0.35 R
/// (docs/method.md 5.3), a little noise is the smaller evil. Part of noisy_radii().
void shrink_at_edges(const CellGrid& grid, const std::vector<float>& floors,
                     std::vector<float>& radii);

/// What each point counts, so that a sampled surface weighs about 1 however dense its points are
/// (docs/method.md 2.2):
///
///   S_i = sum_j w(|p_i - p_j| / R_j),  the point itself included
///   Sbar_i = sum_j w_ij S_j / sum_j w_ij
///   a_i = 1 / max(S_i, 0.8 Sbar_i)
///
/// Sorted order; radii are the R_i, m. Positive and at most 1.
/// @throws Error when there are not as many radii as points, or one is not positive and finite.
[[nodiscard]] std::vector<float> density_weights(const CellGrid& grid, std::span<const float> radii,
                                                 Kernel kernel = Kernel::wyvill);

/// The sums that density_weights() is made of, for those who need them for more than that.
[[nodiscard]] detail::WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii,
                                             Kernel kernel);

[[nodiscard]] std::vector<float> density_weights(const detail::WeightSums& sums);

}  // namespace palpate
