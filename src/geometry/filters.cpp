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
  const detail::Columns columns(grid);
  std::vector<float> diameters(radii.begin(), radii.end());
  for (float& diameter : diameters) diameter *= 2;
  std::vector<std::uint8_t> mask(grid.size());
  detail::for_each_neighborhood(
      grid, {.of_points = diameters, .of_cells = {}},
      [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
        simd::Row nearest[kFewestOthers + 1];
        simd::best_joins().nearest4(columns.join(first, runs), nearest);
        for (std::uint32_t q = 0; q < count; ++q) {
          const std::uint32_t i = first + q;
          const bool alone = nearest[kFewestOthers][q] > diameters[i] * diameters[i];
          mask[i] = alone || sums.own[i] < kShareOfAround * sums.around[i] ? 1 : 0;
        }
      });
  return mask;
}

}  // namespace palpate
