#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "depth/blocks.hpp"
#include "depth/simd/fits.hpp"

namespace palpate::depth {

/// A half of the image as seen from a block: the blocks (u, v) away with at + x u + y v >= 0.
struct HalfImage {
  double at, x, y;

  [[nodiscard]] double above(int u, int v) const { return at + x * u + y * v; }
  /// By how much that changes across a block.
  [[nodiscard]] double block() const { return std::abs(x) + std::abs(y); }
};

/// A plane as seen from a block: (u, v) blocks away its inverse depth is rho + x u + y v, 1/m.
struct FacePlane {
  int column, row;  ///< of the block
  double rho, x, y;
  double variance, slope_variance;  ///< 1/m^2
  double lean_x = 0, lean_y = 0;    ///< covariances of rho with x and y, 1/m^2
  int reach_u = 0, reach_v = 0;     ///< blocks to each side that it was fitted to
  bool straight = false;            ///< bent by no more than noise does on average

  [[nodiscard]] double at(int u, int v) const { return rho + x * u + y * v; }
  [[nodiscard]] double variance_at(int u, int v) const {
    const double lean = 2 * (lean_x * u + lean_y * v);
    return std::max(variance, variance + lean + slope_variance * (u * u + v * v));
  }
};

/// `near` made better: the plane through all blocks up to `reach_u` columns and `reach_v` rows away
/// that lie in all halves, by least squares. None where they are few, have a hole, or noise does
/// not explain what the plane leaves of them.
[[nodiscard]] std::optional<FacePlane> clipped_fit(const simd::FitInput& input,
                                                   const NoiseModel& noise, const FacePlane& near,
                                                   int reach_u, int reach_v,
                                                   std::span<const HalfImage> halves);

/// What the paraboloid through all blocks up to `reach` around the middle of `near` leaves of them:
/// a sum of squares, 1/m^2. None where one is a hole.
[[nodiscard]] std::optional<double> left_by_paraboloid(const simd::FitInput& input,
                                                       const FacePlane& near, int reach);

}  // namespace palpate::depth
