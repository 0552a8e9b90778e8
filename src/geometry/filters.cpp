#include "palpate/geometry/filters.hpp"

#include "geometry/neighborhoods.hpp"
#include "geometry/weight_sums.hpp"

namespace palpate {
namespace {

constexpr float kShareOfAround = 0.35f;
constexpr std::size_t kFewestOthers = 3;

template <class T>
std::vector<T> select(const std::vector<T>& column, std::span<const std::uint32_t> indices) {
  std::vector<T> selected;
  if (column.empty()) return selected;
  selected.reserve(indices.size());
  for (const std::uint32_t i : indices) selected.push_back(column[i]);
  return selected;
}

}  // namespace

PointCloud select(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
  PointCloud result;
  result.origin = cloud.origin;
  result.viewpoint = cloud.viewpoint;
  result.positions = select(cloud.positions, indices);
  result.normals = select(cloud.normals, indices);
  result.colors = select(cloud.colors, indices);
  result.intensities = select(cloud.intensities, indices);
  return result;
}

PointCloud clip(const PointCloud& cloud, const Box& box) {
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (box.contains(cloud.point(i))) inside.push_back(static_cast<std::uint32_t>(i));
  }
  return select(cloud, inside);
}

std::vector<std::uint8_t> speckle_mask(const CellGrid& grid, std::span<const float> radii) {
  const detail::WeightSums sums = detail::weight_sums(grid, radii, simd::best_joins().wyvill_sums);
  std::vector<std::uint8_t> mask(grid.size());
  detail::for_each_group(grid, [&](const detail::Group& group, detail::JoinSpace& space) {
    float largest = 0;
    for (std::uint32_t i = group.begin; i < group.end; ++i) largest = std::max(largest, radii[i]);
    space.ask_for(grid, group);
    detail::gather(grid, group, 2 * largest, space.candidates);
    simd::best_joins().nearest4(space.queries.coordinates(), space.candidates.coordinates(),
                                space.rows.data());
    for (std::uint32_t q = 0; q < group.size(); ++q) {
      const std::uint32_t i = group.begin + q;
      const bool alone = space.results[kFewestOthers][q] > 4 * radii[i] * radii[i];
      mask[i] = alone || sums.own[i] < kShareOfAround * sums.around[i] ? 1 : 0;
    }
  });
  return mask;
}

}  // namespace palpate
