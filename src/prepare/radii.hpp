#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

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

}  // namespace palpate
