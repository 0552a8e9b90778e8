#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// How well a smooth surface explains the points around a place.
struct WindowFit {
  std::size_t points = 0;
  double sigma = 0;      ///< rms distance from the quadratic surface fitted to them, m
  double footprint = 0;  ///< root of the area per point, m
  double shared = 1;     ///< variance of the residuals' means over tiles, against what independent
                         ///< residuals would give: about 1 for these, above for neighbours that err
                         ///< together
};

/// Fits the points within `reach` (m) of `center`. `tile`: side of the tiles, m; 0: `shared` is not
/// looked at. Too few points give a fit of 0 points.
class WindowFitter {
 public:
  [[nodiscard]] WindowFit fit(const CellGrid& grid, const Eigen::Vector3f& center, double reach,
                              double tile = 0);

  static constexpr std::size_t kEnough = 12;  ///< points: twice the terms of a quadratic

 private:
  [[nodiscard]] double subtract_surface();
  [[nodiscard]] double tile_variance(double tile) const;

  std::vector<std::uint32_t> near_;     // kept between calls, to save memory's comings and goings
  std::vector<Eigen::Vector3d> local_;  // height, and place in the plane, in units of the reach
};

}  // namespace palpate
