#include "prepare/columns.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/parallel.hpp"

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

namespace {

constexpr float kLeast = 0.2f;  // a lone point still holds the surface together
constexpr float kMost = 3;

}  // namespace

void weigh_by_counts(const CellGrid& grid, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights) {
  detail::parallel_ranges(weights.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      near.clear();
      grid.within(grid.points()[i], radii[i], near);
      float sum = 0;
      for (const std::uint32_t k : near) sum += static_cast<float>(counts[k]);
      const float mean = near.empty() ? 0 : sum / static_cast<float>(near.size());
      if (!(mean > 0)) continue;
      weights[i] *= std::clamp(static_cast<float>(counts[i]) / mean, kLeast, kMost);
    }
  });
}

void add_twins(std::span<const Twin> twins, SurfacePoints& points) {
  if (twins.empty()) return;
  SurfacePoints::Sheets& sheets = points.sheets;
  for (const Twin& twin : twins) points.density_weights[twin.point] *= 0.5f;
  std::vector<Eigen::Vector3f> positions(points.grid.points().begin(), points.grid.points().end());
  const auto append = [&](auto& column, std::uint32_t Twin::*from) {
    if (column.empty()) return;
    for (const Twin& twin : twins) column.push_back(column[twin.*from]);
  };
  append(positions, &Twin::point);
  points.grid = CellGrid(positions);

  // All of a twin is the point's but what its host knows of the sheet.
  const auto add = [&](auto& column, std::uint32_t Twin::*from) {
    append(column, from);
    if (!column.empty()) column = in_grid_order(points.grid, column);
  };
  add(points.density_weights, &Twin::point);
  add(points.radii, &Twin::point);
  add(points.confidences, &Twin::point);
  add(points.materials, &Twin::point);
  add(points.colors, &Twin::point);
  add(points.normals, &Twin::host);
  add(sheets.sheet, &Twin::host);
  add(sheets.residual, &Twin::host);
  add(sheets.above, &Twin::host);
  add(sheets.below, &Twin::host);
}

}  // namespace palpate
