// Lays blocks out side by side.
#include "scene/policies/block_grid.hpp"

#include "scene/policies/lanes.hpp"

namespace palpate {

void BlockGrid::make_room(const FilteredDepth& depth, int blocks) {
  const auto wide = static_cast<std::size_t>(depth.columns + 2 * blocks);
  const std::size_t size = wide * static_cast<std::size_t>(depth.rows + 2 * blocks) + kLanes;
  if (blocks == margin && wide == stride && size == x.size()) return;
  margin = blocks;
  stride = wide;
  for (auto* column : {&x, &y, &z, &reaches, &precisions, &sums}) column->assign(size, 0);
  per_r2.assign(size, kNowhere);
  ones.assign(size, 1);
}

void BlockGrid::lay_out_places(const FilteredDepth& depth, std::size_t v) {
  const auto columns = static_cast<std::size_t>(depth.columns);
  const Eigen::Vector3f* position = depth.positions.data() + v * columns;
  const std::size_t first = place(0, static_cast<int>(v));
  for (std::size_t at = first; at < first + columns; ++at) {
    x[at] = position->x();
    y[at] = position->y();
    z[at] = position->z();
    ++position;
  }
}

}  // namespace palpate
