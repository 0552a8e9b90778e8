#include "field/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "field/traversal.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Puts the children on the stack, the nearest on top: it is where a surface shows soonest.
void push_nearest_first(CellStack& stack, const CellTest& test, std::span<const CellGrid::Cell> all,
                        const CellGrid::Cell& cell) noexcept {
  std::array<std::pair<float, std::uint32_t>, 8> children;
  for (std::uint32_t k = 0; k < cell.children; ++k) {
    const std::pair child{test.squared_distance(all[cell.first_child + k]), cell.first_child + k};
    std::uint32_t at = k;
    for (; at > 0 && children[at - 1] < child; --at) children[at] = children[at - 1];
    children[at] = child;
  }
  for (std::uint32_t k = 0; k < cell.children; ++k) stack.push(children[k].second);
}

/// What the points of one layer can add to the weight sum anywhere in the ball. Stops at `enough`
/// or when `visits` has run out.
double largest_weight(const ImplicitSurface& surface, const ActiveLayer& layer, const Ball& ball,
                      double radius, double enough, int& visits) noexcept {
  const SurfacePoints& points = *layer.points;
  const CellTest test(ball.center - points.origin);
  const PointTest point_test(points, ball.center - points.origin);
  const auto ball_radius = static_cast<float>(ball.radius);
  double total = 0;
  CellStack stack(points);
  while (!stack.empty() && visits > 0 && total < enough) {
    --visits;
    const std::uint32_t index = stack.pop();
    const CellGrid::Cell& cell = points.grid.cells()[index];
    const double reach = std::max<double>(points.cell_reach[index], radius);
    if (!test.near(cell, reach + layer.least_radius + ball.radius)) continue;
    if (cell.children > 0) {
      push_nearest_first(stack, test, points.grid.cells(), cell);
      continue;
    }
    for (std::uint32_t i = cell.begin; i < cell.end && total < enough; ++i) {
      if (visits <= 0) break;
      --visits;
      const float most = radius > 0 ? static_cast<float>(radius) : largest_radius(layer, i);
      if (point_test.far(i, most + ball_radius)) continue;
      const double squared = position_now(layer, i, ball.center).squaredNorm();
      const double own = radius > 0 ? radius : radius_now(layer, i);
      const double reaching = own + ball.radius;
      if (squared >= reaching * reaching || weightless(points, i)) continue;
      const double r = std::max(0.0, std::sqrt(squared) - ball.radius) / own;
      total += weight_now(layer, i, surface.options.raw_weights) *
               evaluate(surface.options.kernel, r * r).w;
    }
  }
  return total;
}

}  // namespace

bool is_free_space(const ImplicitSurface& surface, std::span<const ActiveLayer> layers, int sources,
                   const Ball& ball, double radius, int& visits) noexcept {
  double smallest = std::numeric_limits<double>::infinity();
  for (const ActiveLayer& layer : layers) {
    smallest = std::min(smallest, layer.points->smallest_radius);
  }
  const double level = free_level(surface, radius > 0 ? radius : smallest);
  double w[simd::kMaxSources] = {};
  for (const ActiveLayer& layer : layers) {
    if (layer.weight <= 0) continue;
    w[layer.source] +=
        largest_weight(surface, layer, ball, radius, level - w[layer.source], visits);
    if (w[layer.source] >= level || visits <= 0) return false;
  }
  return united(w, sources) < level;
}

}  // namespace palpate
