#include "palpate/geometry/filters.hpp"

#include <algorithm>

#include "geometry/distance.hpp"
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

// Are there enough others within the smaller of both points' diameters?
bool has_company(const CellGrid& grid, std::span<const float> diameters, std::uint32_t i,
                 std::span<const simd::Run> runs) {
  std::size_t others = 0;
  for (const simd::Run& run : runs) {
    for (std::uint32_t j = run.begin; j < run.end; ++j) {
      const float reach = std::min(diameters[i], diameters[j]);
      const float squared = detail::squared_distance(grid.points()[i], grid.points()[j]);
      if (squared <= reach * reach && j != i && ++others == kFewestOthers) return true;
    }
  }
  return false;
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
  std::vector<float> diameters(radii.begin(), radii.end());
  for (float& diameter : diameters) diameter *= 2;
  std::vector<std::uint8_t> mask(grid.size());
  detail::for_each_neighborhood(
      grid, {.of_points = diameters, .of_cells = {}},
      [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
        for (std::uint32_t i = first; i < first + count; ++i) {
          const bool alone = !has_company(grid, diameters, i, runs);
          mask[i] = alone || sums.own[i] < kShareOfAround * sums.around[i] ? 1 : 0;
        }
      });
  return mask;
}

}  // namespace palpate
