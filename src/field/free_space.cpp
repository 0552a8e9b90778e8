#include "field/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/traversal.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kMaxVisits = 8192;  // points and cells

/// What the points of one layer can add to the weight sum anywhere in the ball. Stops at `enough`
/// or when `visits` has run out.
double largest_weight(const ImplicitSurface& surface, const ActiveLayer& layer, const Ball& ball,
                      double radius, double enough, int& visits) noexcept {
  const CellTest test(ball.center - layer.points->origin);
  double total = 0;
  CellStack stack(*layer.points);
  while (!stack.empty() && visits > 0 && total < enough) {
    --visits;
    const std::uint32_t index = stack.pop();
    const CellGrid::Cell& cell = layer.points->grid.cells()[index];
    const double reach = std::max<double>(layer.points->cell_reach[index], radius);
    if (!test.near(cell, reach + ball.radius)) continue;
    if (cell.children > 0) {
      stack.push_children(cell);
      continue;
    }
    for (std::uint32_t i = cell.begin; i < cell.end && total < enough; ++i, --visits) {
      const double distance = position_now(layer, i, ball.center).norm();
      if (weightless(*layer.points, i)) continue;
      const double own = radius > 0 ? radius : radius_now(layer, i);
      const double r = std::max(0.0, distance - ball.radius) / own;
      total += weight_now(layer, i, surface.options.raw_weights) *
               evaluate(surface.options.kernel, r * r).w;
    }
  }
  return total;
}

}  // namespace

bool is_free_space(const ImplicitSurface& surface, std::span<const ActiveLayer> layers, int sources,
                   const Ball& ball, double radius) noexcept {
  double smallest = std::numeric_limits<double>::infinity();
  for (const ActiveLayer& layer : layers) {
    smallest = std::min(smallest, layer.points->smallest_radius);
  }
  const double level = free_level(surface, radius > 0 ? radius : smallest);
  double w[simd::kMaxSources] = {};
  int visits = kMaxVisits;
  for (const ActiveLayer& layer : layers) {
    if (layer.weight <= 0) continue;
    w[layer.source] +=
        largest_weight(surface, layer, ball, radius, level - w[layer.source], visits);
    if (w[layer.source] >= level || visits <= 0) return false;
  }
  return united(w, sources) < level;
}

}  // namespace palpate
