#include "prepare/columns.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr float kTrusted = 0.5f;  // confidence

}  // namespace

std::vector<std::uint32_t> first_of_each_place(const CellGrid& grid) {
  std::vector<std::uint32_t> first;
  first.reserve(grid.size());
  for (const CellGrid::Cell& cell : grid.cells()) {
    if (cell.children > 0) continue;
    const auto points = grid.points().subspan(cell.begin, cell.size());
    for (auto p = points.begin(); p != points.end(); ++p) {
      if (std::find(points.begin(), p, *p) != p) continue;
      first.push_back(grid.order()[static_cast<std::size_t>(p - grid.points().begin())]);
    }
  }
  std::sort(first.begin(), first.end());
  return first;
}

std::vector<float> materials_of(const CellGrid& grid, const std::vector<float>& intensities) {
  auto materials = in_grid_order(grid, intensities);
  const auto [low, high] = std::minmax_element(materials.begin(), materials.end());
  const float from = *low;
  const float range = *high - *low;
  for (float& m : materials) m = range > 0 ? (m - from) / range : 1.0f;
  return materials;
}

void tell_trust(const SurfacePoints& points, PrepareReport& report) {
  std::vector<float> felt;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.density_weights[i] > 0) felt.push_back(points.confidences[i]);
  }
  if (felt.empty()) return;
  const auto tenth = felt.begin() + static_cast<std::ptrdiff_t>(felt.size() / 10);
  std::nth_element(felt.begin(), tenth, felt.end());
  report.trust_low = *tenth;
  const auto doubted = std::ranges::count_if(felt, [](float c) { return c < kTrusted; });
  report.untrusted = static_cast<double>(doubted) / static_cast<double>(felt.size());
}

PointCloud placed(PointCloud cloud, const Eigen::Isometry3d& T_world_sensor) {
  const Eigen::Matrix3f turn = T_world_sensor.linear().cast<float>();
  cloud.origin = T_world_sensor * cloud.origin;
  if (!turn.isIdentity(0)) {
    for (auto& p : cloud.positions) p = turn * p;
    for (auto& n : cloud.normals) n = turn * n;
  }
  if (cloud.viewpoint) cloud.viewpoint = T_world_sensor * *cloud.viewpoint;
  return cloud;
}

}  // namespace palpate
