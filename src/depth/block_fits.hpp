#pragma once

#include <vector>

#include "depth/block_grid.hpp"
#include "depth/simd/fit_row.hpp"
#include "palpate/depth/filtered_depth.hpp"

namespace palpate::depth {

/// What is known of each block of one frame, in the sensor's frame, before it becomes points: what
/// the fits write, the temporal filter changes and the output is made from. Row by row; all columns
/// have grid.size() entries, those of empty blocks mean nothing.
///
/// Along the ray (x, y, 1) of a block its inverse depth is `rho`; near it, it is
/// rho + slope_x (x' - x) + slope_y (y' - y). A plane is exactly that: its points p keep
/// (slope_x, slope_y, rho - slope_x x - slope_y y) . p = 1.
struct BlockFits {
  BlockGrid grid;
  std::vector<BlockState> states;
  std::vector<float> rho;             ///< inverse depth, 1/m
  std::vector<float> variance;        ///< of rho, 1/m^2, with the noise's correlation in it
  std::vector<float> slope_x;         ///< d rho / d x, 1/m
  std::vector<float> slope_y;         ///< d rho / d y, 1/m
  std::vector<float> slope_variance;  ///< of either slope (the larger one), 1/m^2
  std::vector<float> confidences;     ///< of the slopes, 0-1; 0: they are unknown and 0

  // Of fitted blocks:
  std::vector<std::uint8_t> flat;     ///< is it a plane over its window?
  std::vector<std::uint8_t> reach_u;  ///< blocks to the side of the largest window; 0: no edge near
  std::vector<std::uint8_t> reach_v;  ///< and to its top

  [[nodiscard]] std::size_t size() const { return states.size(); }

  /// Takes memory when the size is new, and no more.
  void resize(const BlockGrid& new_grid) {
    grid = new_grid;
    const std::size_t size = new_grid.size();
    states.resize(size, BlockState::empty);
    for (auto* column : {&flat, &reach_u, &reach_v}) column->resize(size);
    for (auto* column : {&rho, &variance, &slope_x, &slope_y, &slope_variance, &confidences}) {
      column->resize(size);
    }
  }

  /// Where a row begins in each of the columns.
  [[nodiscard]] simd::FitRow row(int row) {
    const std::size_t i = grid.index(0, row);
    return {reinterpret_cast<std::uint8_t*>(&states[i]),
            &rho[i],
            &variance[i],
            &slope_x[i],
            &slope_y[i],
            &slope_variance[i],
            &confidences[i],
            &flat[i],
            &reach_u[i],
            &reach_v[i]};
  }
};

}  // namespace palpate::depth
