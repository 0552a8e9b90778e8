// Lays blocks out side by side.
#include "stream/padded_blocks.hpp"

#include "stream/simd/rims.hpp"

namespace palpate {

bool PaddedBlocks::make_room(const FilteredDepth& depth, int blocks) {
  const auto wide = static_cast<std::size_t>(depth.columns + 2 * blocks);
  const std::size_t size =
      wide * static_cast<std::size_t>(depth.rows + 2 * blocks) + simd::kRimLanes;
  if (blocks == margin && wide == stride && size == x.size()) return false;
  margin = blocks;
  stride = wide;
  for (auto* column : {&x, &y, &z, &reaches, &precisions, &sums}) column->assign(size, 0);
  per_r2.assign(size, kNowhere);
  ones.assign(size, 1);
  return true;
}

void PaddedBlocks::lay_out_positions(const FilteredDepth& depth, int v, int first, int count) {
  const Eigen::Vector3f* position =
      depth.positions.data() + static_cast<std::ptrdiff_t>(v) * depth.columns + first;
  const std::size_t begin = index(first, v);
  for (std::size_t at = begin; at < begin + static_cast<std::size_t>(count); ++at) {
    x[at] = position->x();
    y[at] = position->y();
    z[at] = position->z();
    ++position;
  }
}

}  // namespace palpate
