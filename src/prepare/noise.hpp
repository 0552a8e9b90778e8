#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The noise of raw points.
struct Noise {
  double sigma = 0;  ///< median rms distance from a smooth surface, m
  double excess =
      1;  ///< by how much sigma_n delta of narrow windows (NoiseMap) falls short of what
          ///< averaging has to cope with, because neighbours err together; 1: they do not
};

/// Measures it on a sample of the points. `spacing`: of the points, m.
///
/// Noise that neighbours share (a depth camera's, mostly) is mistaken for shape in narrow windows
/// and does not average out as fast as its variance says. Wide windows tell, as long as they see
/// noise and no shape: on the flattest of them the residuals no longer grow with the window
/// (docs/method.md 5.2).
[[nodiscard]] Noise measure_noise(const CellGrid& grid, double spacing);

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
