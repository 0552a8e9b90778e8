#pragma once

#include <string>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate::app {

/// A cloud without stray points seen along its shortest side, as counts on a grid.
struct DensityMap {
  int columns = 0;
  int rows = 0;
  int horizontal = 0;               ///< axis (0-2) that runs to the right
  int vertical = 0;                 ///< axis that runs upwards
  double cell = 0;                  ///< width of a cell, m; it is twice as high, like a letter
  std::vector<std::size_t> counts;  ///< row by row, the top one first

  [[nodiscard]] std::size_t place(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

[[nodiscard]] DensityMap map_density(const PointCloud& cloud, int columns);

/// The map as lines of text, denser is darker; in colours when `colored`.
[[nodiscard]] std::string draw(const DensityMap& map, bool colored);

}  // namespace palpate::app
