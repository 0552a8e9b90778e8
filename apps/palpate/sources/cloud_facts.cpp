// Measures spacing and borders of a cloud.
#include "apps/palpate/sources/cloud_facts.hpp"

#include <algorithm>
#include <cmath>

#include "palpate/geometry/spacing.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kSample = 20'000;

/// The median of what length(nearest others) is over a sample of the points; 0: none has so many.
double median_of_nearest(const CellGrid& grid, std::size_t others, const auto& length) {
  const std::size_t stride = grid.size() / kSample + 1;
  std::vector<CellGrid::Neighbor> found;
  std::vector<float> lengths;
  for (std::size_t i = 0; i < grid.size(); i += stride) {
    grid.nearest(grid.points()[i], others + 1, found);  // the point itself comes first
    if (found.size() <= others) continue;
    lengths.push_back(static_cast<float>(length(std::span(found).subspan(1))));
  }
  return median(lengths);
}

}  // namespace

bool on_a_line(std::span<const Eigen::Vector3f> points) {
  Eigen::Vector3f along = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f offset = point - points.front();
    if (offset.cross(along).norm() > 1e-4f * offset.norm() * along.norm()) return false;
    if (offset.squaredNorm() > along.squaredNorm()) along = offset;
  }
  return true;
}

double nearest_three(const CellGrid& grid) {
  return median_of_nearest(grid, 3, [](std::span<const CellGrid::Neighbor> others) {
    double sum = 0;
    for (const auto& other : others) sum += std::sqrt(static_cast<double>(other.squared_distance));
    return sum / 3;
  });
}

double spacing_from_area(const CellGrid& grid) {
  return median_of_nearest(grid, 8, [](std::span<const CellGrid::Neighbor> others) {
    double squares = 0;
    for (const auto& other : others) squares += static_cast<double>(other.squared_distance);
    return std::sqrt(squares / 8 / 1.5);  // exact on a square grid
  });
}

double rim_share(const SurfacePoints& points) {
  const CellGrid& grid = points.grid;
  const std::size_t stride = grid.size() / kSample + 1;
  std::vector<std::uint32_t> near;
  std::size_t looked_at = 0;
  std::size_t rim = 0;
  for (std::size_t i = 0; i < grid.size(); i += stride) {
    const float radius = points.radii.empty() ? static_cast<float>(points.radius) : points.radii[i];
    near.clear();
    grid.within(grid.points()[i], radius, near);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t k : near) mean += (grid.points()[k] - grid.points()[i]).cast<double>();
    mean /= static_cast<double>(std::max<std::size_t>(near.size(), 1));
    ++looked_at;
    if (near.size() < 4 || mean.norm() > 0.25 * static_cast<double>(radius)) ++rim;
  }
  return looked_at == 0 ? 0 : static_cast<double>(rim) / static_cast<double>(looked_at);
}

}  // namespace palpate::app
