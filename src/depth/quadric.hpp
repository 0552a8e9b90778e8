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

  int column, row;          ///< of the block
  int reach;                ///< blocks to each side that are looked at
  double rho, unit;         ///< 1/m
  Terms a = Terms::Zero();  ///< the squared derivative by r is 1 in the mean
  double side = 0;          ///< sign of that derivative on the side that is seen
  double support = 0;       ///< blocks that it holds
  Products spread =
      Products::Zero();  ///< lower triangular; its transpose times it: covariance of a

  /// Is the block (u, v) away, of inverse depth `there`, off by no more than the root of `square`,
  /// to the first order?
  [[nodiscard]] bool holds(int u, int v, double there, double square) const;
  /// Does noise explain the mean and the tilts of what it leaves of the blocks around the block (u,
  /// v) away, as far as they may be of that block's surface? To the first order.
  [[nodiscard]] bool explains(const simd::BlockRows& blocks, const SameSurface& same, int u,
                              int v) const;
  /// nullopt where the ray passes it.
  [[nodiscard]] std::optional<Sight> at(int u, int v) const;
};

/// A quadric's value along a row of blocks, `v` in reaches from its block, in its own units.
struct QuadricLine {
  double c0, c1, c2, b0, b1, a;

  QuadricLine(const Quadric::Terms& t, double v)
      : c0(t[0] + v * (t[2] + t[5] * v)),
        c1(t[1] + t[4] * v),
        c2(t[3]),
        b0(t[6] + t[8] * v),
        b1(t[7]),
        a(t[9]) {}

  /// value(u, r) = c(u) + r (b(u) + a r)
  [[nodiscard]] double c(double u) const { return c0 + u * (c1 + c2 * u); }
  [[nodiscard]] double b(double u) const { return b0 + b1 * u; }
  [[nodiscard]] double value(double u, double r) const { return c(u) + r * (b(u) + a * r); }
  [[nodiscard]] double slope(double u, double r) const { return b(u) + 2 * a * r; }
  /// Is (u, r) within a square of the surface that has this side?
  [[nodiscard]] bool holds(double u, double r, double side, double square) const {
    const double off = value(u, r);
    const double across = slope(u, r);
    return side * across > 0 && off * off <= square * across * across;
  }
};

/// Was a block fitted, and not by a plane? Paraboloids serve, or no window does.
[[nodiscard]] inline bool is_bent(const BlockFits& fits, std::size_t i) {
  return fits.states[i] == FilteredDepth::State::fitted && fits.flat[i] == simd::kBentWindow;
}

/// The quadric around a bent block that explains all bent blocks which lie on it (docs/method.md
/// 6.4). nullopt if they are few or not nearly all, noise does not explain what it leaves of them,
/// or it explains no more of them than noise lets it beyond their best plane.
[[nodiscard]] std::optional<Quadric> fit_quadric(const simd::FitInput& input,
                                                 const NoiseModel& noise, const BlockFits& fits,
                                                 int column, int row);

}  // namespace palpate::depth
