#include "palpate/geometry/filters.hpp"

#include <algorithm>

#include "geometry/distance.hpp"
#include "geometry/parallel.hpp"
#include "geometry/speckle.hpp"
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

// Are there enough others within the smaller of both points' diameters? Whoever weighs as much as
// that many others within their radii has company without a look.
bool has_company(const CellGrid& grid, std::span<const float> radii, float own_sum, std::uint32_t i,
                 std::vector<std::uint32_t>& near) {
  if (own_sum >= kFewestOthers) return true;
  near.clear();
  grid.within(grid.points()[i], 2 * radii[i], near);
  const auto others = std::ranges::count_if(near, [&](std::uint32_t j) {
    const float squared = detail::squared_distance(grid.points()[i], grid.points()[j]);
    return j != i && squared <= 4 * radii[j] * radii[j];
  });
  return static_cast<std::size_t>(others) >= kFewestOthers;
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
  return detail::speckle_mask(grid, radii,
                              detail::weight_sums(grid, radii, simd::best_joins().wyvill_sums));
}

std::vector<std::uint8_t> detail::speckle_mask(const CellGrid& grid, std::span<const float> radii,
                                               const WeightSums& sums) {
  std::vector<std::uint8_t> mask(grid.size());
  parallel_ranges(grid.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::uint32_t>(k);
      const bool faint = sums.own[i] < kShareOfAround * sums.around[i];
      mask[i] = faint || !has_company(grid, radii, sums.own[i], i, near) ? 1 : 0;
    }
  });
  return mask;
}

}  // namespace palpate
