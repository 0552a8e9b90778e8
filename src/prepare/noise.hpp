#pragma once

#include <cstdint>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "prepare/sheets.hpp"

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

/// 1 for each point that is much farther from others than most and on no sheet with them.
/// `typical`: the median spacing, m. In sorted order.
[[nodiscard]] std::vector<std::uint8_t> find_strays(const SheetInput& input, double typical);

}  // namespace palpate
