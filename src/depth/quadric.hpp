// Surfaces of the second degree through bent blocks.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "depth/blocks.hpp"
#include "depth/simd/fits.hpp"

namespace palpate::depth {

inline constexpr int kLargestReach = 25;  ///< Quadric::reach, at most

/// A surface of the second degree as seen from a block: ball, cylinder, cone or any other whose
/// inverse depth r keeps a . (1, u, v, u^2, u v, v^2, r, r u, r v, r^2) = 0 along all rays. u and v
/// count in `reach` blocks from the block, r in `unit` from `rho`.
struct Quadric {
  using Terms = Eigen::Matrix<double, 10, 1>;
  using Products = Eigen::Matrix<double, 10, 10>;

  /// What the block (u, v) away sees of it.
  struct Sight {
    double rho, x, y;                 ///< inverse depth and its change from block to block, 1/m
    double variance, slope_variance;  ///< of rho and of the less certain change, 1/m^2
  };

  int column, row;                         ///< of the block
  int reach;                               ///< blocks to each side that are looked at
  double rho, unit;                        ///< 1/m
  Terms a = Terms::Zero();                 ///< the squared derivative by r is 1 in the mean
  double side = 0;                         ///< sign of that derivative on the side that is seen
  double support = 0;                      ///< blocks that it explains
  Products covariance = Products::Zero();  ///< of a

  /// Is the block (u, v) away, of inverse depth `there`, off by no more than the root of `square`,
  /// to the first order?
  [[nodiscard]] bool holds(int u, int v, double there, double square) const;
  /// nullopt where the ray passes it.
  [[nodiscard]] std::optional<Sight> at(int u, int v) const;
};

/// Was a block fitted, and not by a plane? Paraboloids serve, or no window does.
[[nodiscard]] inline bool is_bent(const BlockFits& fits, std::size_t i) {
  return fits.states[i] == FilteredDepth::State::fitted && fits.flat[i] == 0;
}

/// The quadric around a bent block that explains all bent blocks which lie on it (docs/method.md
/// 6.4). nullopt if they are few or not nearly all, or noise does not explain what it leaves of
/// them.
[[nodiscard]] std::optional<Quadric> fit_quadric(const simd::FitInput& input,
                                                 const NoiseModel& noise, const BlockFits& fits,
                                                 int column, int row);

}  // namespace palpate::depth
