// Moves points along their normals by what their neighbours in a sheet have in common.
#include "extras/splats/splat_sheet.hpp"

#include <algorithm>
#include <utility>

#include "extras/splats/splat_half_light.hpp"
#include "geometry/parallel.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {
namespace {

constexpr float kSameSide = 0.7071F;    // cos 45 degrees, between normals that mix (measured)
constexpr std::size_t kNeighbors = 32;  // that a point is drawn towards, at most (measured)
constexpr float kFar = 4;               // edges, to the farthest of them (measured)
constexpr float kWidth = 2;             // edges, deviation of their weight (measured)
constexpr int kProjections = 3;  // after two, two layers of a thick shell may be left (measured)

// Calls body(other, weight) for the neighbours of a point in its sheet. Weights are below 0 where
// the other's normal is turned to the other side.
template <class Body>
void each_of_sheet(const SplatCell& point, std::span<const SplatCell> points,
                   std::span<const CellGrid::Neighbor> neighbors, float edge, const Body& body) {
  for (const CellGrid::Neighbor& neighbor : neighbors) {
    const SplatCell& other = points[neighbor.index];
    const float square = neighbor.squared_distance / (edge * edge);
    const float agreement = other.normal.dot(point.normal);
    if (square > kFar * kFar || !(std::abs(agreement) >= kSameSide)) continue;
    const float weight = other.depth * std::exp(-square / (2 * kWidth * kWidth));
    body(other, std::copysign(weight, agreement));
  }
}

// The share of light from behind, where normals are turned by the sign of `weight`.
float turned_share(const SplatCell& cell, float weight) {
  return weight < 0 ? 1 - cell.behind : cell.behind;
}

// Moves a point along its normal to the mean of its neighbours of the same sheet.
SplatCell projected(const SplatCell& point, std::span<const SplatCell> points,
                    std::span<const CellGrid::Neighbor> neighbors, float edge) {
  float sum = 0;
  float height = 0;
  float behind = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  each_of_sheet(point, points, neighbors, edge, [&](const SplatCell& other, float signed_weight) {
    const float weight = std::abs(signed_weight);
    sum += weight;
    height += weight * point.normal.dot(other.position - point.position);
    normal += signed_weight * other.normal;
    behind += weight * turned_share(other, signed_weight);
  });
  SplatCell moved = point;
  if (!(sum > 0)) return moved;
  moved.position += height / sum * point.normal;
  moved.normal = normal.normalized();
  moved.behind = behind / sum;
  return moved;
}

// The mean height over a point's neighbours in the same sheet, along its normal. Heights are above
// their own points, so what is bent stays so.
float mean_height(const SplatCell& point, std::span<const SplatCell> points,
                  std::span<const CellGrid::Neighbor> neighbors, float edge) {
  float sum = 0;
  float height = 0;
  each_of_sheet(point, points, neighbors, edge, [&](const SplatCell& other, float weight) {
    if (std::isnan(other.height)) return;
    sum += std::abs(weight);
    height += weight * other.height;
  });
  return sum > 0 ? height / sum : point.height;
}

// Makes one point of those that share a cell.
SplatCell merged(std::span<const SplatCell> points) {
  SplatCell mean;
  mean.key = points.front().key;
  float confident = 0;
  for (const SplatCell& each : points) {
    mean.depth += each.depth;
    mean.position += each.depth * (each.position - points.front().position);
    mean.color += each.depth * each.color;
    const float side = each.normal.dot(points.front().normal);
    mean.normal += std::copysign(each.depth, side) * each.normal;
    mean.behind += each.depth * turned_share(each, side);
    confident += each.confident ? each.depth : 0;
  }
  mean.position = points.front().position + mean.position / mean.depth;
  mean.color /= mean.depth;
  mean.behind /= mean.depth;
  mean.normal.normalize();
  mean.confident = 2 * confident >= mean.depth;
  return mean;
}

std::vector<SplatCell> one_a_cell(std::vector<SplatCell> points, const SplatGrid& grid) {
  for (SplatCell& each : points) each.key = grid.key_of(each.position).value_or(each.key);
  std::ranges::stable_sort(points, {}, &SplatCell::key);
  std::vector<SplatCell> merged_points;
  for (std::size_t i = 0, end = 0; i < points.size(); i = end) {
    while (end < points.size() && points[end].key == points[i].key) ++end;
    merged_points.push_back(merged(std::span(points).subspan(i, end - i)));
  }
  return merged_points;
}

// Points along the curve of their index.
struct Sheet {
  explicit Sheet(std::span<const SplatCell> cells) : points(cells.size()) {
    std::vector<Eigen::Vector3f> positions(cells.size());
    std::ranges::transform(cells, positions.begin(), &SplatCell::position);
    index = CellGrid(positions);
    for (std::size_t i = 0; i < cells.size(); ++i) points[i] = cells[index.order()[i]];
  }

  // Calls body(i, neighbors) for each point.
  template <class Body>
  void each(const Body& body) const {
    parallel_each_with<std::vector<CellGrid::Neighbor>>(
        points.size(), 256, [&](std::size_t i, std::vector<CellGrid::Neighbor>& neighbors) {
          index.nearest(points[i].position, kNeighbors, neighbors);
          body(i, neighbors);
        });
  }

  CellGrid index;
  std::vector<SplatCell> points;
};

std::vector<SplatCell> project(std::span<const SplatCell> cells, const SplatGrid& grid) {
  const Sheet sheet(cells);
  std::vector<SplatCell> moved(cells.size());
  sheet.each([&](std::size_t i, std::span<const CellGrid::Neighbor> neighbors) {
    moved[i] = projected(sheet.points[i], sheet.points, neighbors, grid.edge);
  });
  return one_a_cell(std::move(moved), grid);
}

// Moves points by their heights, which are made as smooth as the sheet is.
std::vector<SplatCell> lift(std::span<const SplatCell> cells, const SplatGrid& grid) {
  Sheet sheet(cells);
  std::vector<float> heights(cells.size());
  for (int k = 0; k < kProjections; ++k) {
    sheet.each([&](std::size_t i, std::span<const CellGrid::Neighbor> neighbors) {
      heights[i] = mean_height(sheet.points[i], sheet.points, neighbors, grid.edge);
    });
    for (std::size_t i = 0; i < heights.size(); ++i) sheet.points[i].height = heights[i];
  }
  for (SplatCell& point : sheet.points) {
    if (!std::isnan(point.height)) point.position += point.height * point.normal;
  }
  return one_a_cell(std::move(sheet.points), grid);
}

}  // namespace

std::vector<SplatCell> drawn_together(std::vector<SplatCell> cells,
                                      std::span<const SplatShare> shares,
                                      std::span<const Splat> splats, const SplatGrid& grid,
                                      const std::function<void(double)>& progress) {
  for (int k = 0; k < kProjections; ++k) {
    cells = project(cells, grid);
    progress((k + 1) / (kProjections + 1.0));
  }
  find_half_light(cells, shares, splats, grid, kFar);
  return lift(cells, grid);
}

}  // namespace palpate::detail
