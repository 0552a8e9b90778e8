// Fits all of a small frame and compares what they say of a block with the truth.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "depth/simd/fits.hpp"
#include "depth/window_fits.hpp"
#include "sim/simulated_depth.hpp"

namespace palpate::test {

/// Fits all blocks of a frame.
inline depth::BlockFits fit_all(const depth::Blocks& blocks, const NoiseModel& noise,
                                const simd::FitFunctions& functions = simd::best_fits()) {
  depth::BlockFits fits;
  fits.resize(blocks.grid);
  depth::FitRegion region;
  region.set(blocks.grid);
  depth::WindowFits windows(functions);
  const KeptTiles none{.columns = blocks.grid.columns, .flags = {}};
  (void)windows.fit(blocks, noise, 0.0035, region, none, fits);  // all of it
  return fits;
}

inline Eigen::Vector3d normal_of(const depth::BlockFits& fits, int column, int row) {
  const std::size_t i = fits.grid.index(column, row);
  const double a = fits.slope_x[i];
  const double b = fits.slope_y[i];
  return -Eigen::Vector3d(a, b, fits.rho[i] - a * fits.grid.x(column) - b * fits.grid.y(row))
              .normalized();
}

inline Eigen::Vector3d position_of(const depth::BlockFits& fits, int column, int row) {
  return Eigen::Vector3d(fits.grid.x(column), fits.grid.y(row), 1) /
         fits.rho[fits.grid.index(column, row)];
}

/// Errors of blocks: root mean squares and the largest.
struct Errors {
  double height = 0;  // m
  double angle = 0;   // rad
  double worst = 0;   // rad
  int count = 0;

  void add(const Solid& truth, const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
    const Distance exact = distance_and_normal(truth, position);
    height += exact.value * exact.value;
    const double turned = std::acos(std::min(1.0, exact.gradient.dot(normal)));
    angle += turned * turned;
    worst = std::max(worst, turned);
    ++count;
  }
  [[nodiscard]] double rms_height() const { return std::sqrt(height / count); }
  [[nodiscard]] double rms_angle() const { return std::sqrt(angle / count); }
};

}  // namespace palpate::test
