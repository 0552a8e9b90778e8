#include "prepare/columns.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr float kTrusted = 0.5f;  // confidence

}  // namespace

std::vector<std::uint32_t> first_of_each_place(const CellGrid& grid) {
  std::vector<std::uint8_t> later(grid.size());  // 1: another one stands there before it
  for (const CellGrid::Cell& cell : grid.cells()) {
    if (cell.children > 0) continue;
    const auto points = grid.points().subspan(cell.begin, cell.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto before = points.first(k);
      const bool repeated = std::ranges::find(before, points[k]) != before.end();
      later[grid.order()[cell.begin + k]] = repeated ? 1 : 0;
    }
  }
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < later.size(); ++i) {
    if (later[i] == 0) first.push_back(i);
  }
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
