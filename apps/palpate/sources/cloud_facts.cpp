// Measures spacing and borders of a cloud.
#include "apps/palpate/sources/cloud_facts.hpp"

#include <algorithm>
#include <cmath>

#include "palpate/geometry/spacing.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kSample = 20'000;
constexpr std::size_t kNeighbors = 8;

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

SpacingFacts measure_spacing(const CellGrid& grid) {
  const std::size_t stride = grid.size() / kSample + 1;
  std::vector<CellGrid::Neighbor> found;
  std::vector<float> three;
  std::vector<float> area;
  for (std::size_t i = 0; i < grid.size(); i += stride) {
    found.clear();
    grid.nearest(grid.points()[i], kNeighbors + 1, found);  // the point itself comes first
    if (found.size() < 4) continue;
    double sum = 0;
    for (std::size_t k = 1; k <= 3; ++k)
      sum += std::sqrt(static_cast<double>(found[k].squared_distance));
    three.push_back(static_cast<float>(sum / 3));
    if (found.size() <= kNeighbors) continue;
    double squares = 0;
    for (std::size_t k = 1; k <= kNeighbors; ++k)
      squares += static_cast<double>(found[k].squared_distance);
    const double square = squares / kNeighbors / 1.5;  // exact on a square grid
    area.push_back(static_cast<float>(std::sqrt(square)));
  }
  return {median(three), median(area)};
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
