// Averages material, presence and velocity, and bounds the weights in a ball (docs/method.md 2.10).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "field/evaluate.hpp"
#include "field/formulas.hpp"
#include "field/selection.hpp"

namespace palpate {

PatchSurface mean_surface(const ImplicitSurface& surface, const Patch& patch,
                          const Eigen::Vector3d& x, std::span<const double> presences) noexcept {
  using Eigen::Vector3d;
  const PatchColumns& c = patch.columns();
  const Vector3d local = x - patch.center();
  PatchSurface result;
  double total = 0;
  double material = 0;
  double presence = 0;
  Vector3d velocity = Vector3d::Zero();
  std::array<double, simd::kMaxSources> by_source{};
  for (int run = 0; patch.points() > 0 && run < c.labels * c.sources; ++run) {
    const auto s = static_cast<std::size_t>(run % c.sources);
    double present = 0;
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; ++i) {
      const Vector3d q = Vector3d(c.position[0][i], c.position[1][i], c.position[2][i]) - local;
      const double r2 = q.squaredNorm() * c.inverse_r2[i];
      if (r2 >= 1) continue;
      const double w = c.weight[i] * evaluate(surface.options.kernel, r2).w;
      by_source[s] += w;
      total += w;
      material += w * (c.material ? c.material[i] : 1);
      present += w * (c.presence ? c.presence[i] : 1);
      if (c.moves) velocity += w * Vector3d(c.velocity[0][i], c.velocity[1][i], c.velocity[2][i]);
    }
    presence += present * (presences.empty() ? 1 : presences[s]);
  }
  const auto first = by_source.begin();
  const auto most = std::max_element(first, first + c.sources);
  const double largest = *most;
  result.source = largest > 0 ? static_cast<int>(most - first) : -1;
  if (total <= 0) return result;
  result.material = material / total;
  if (c.presence || !presences.empty()) {
    result.presence = std::min(1.0, presence / largest);
  }
  result.velocity = velocity / total;
  return result;
}

namespace {

using Eigen::Vector3d;

/// Walks the cells of a layer that come near a ball, the nearest child first: it is where a surface
/// shows soonest.
class NearCells {
 public:
  NearCells(const ActiveLayer& layer, const Ball& ball, double radius) noexcept
      : points_(*layer.points),
        test_(ball.center - points_.origin),
        stack_(points_),
        radius_(radius),
        extra_(layer.least_radius + ball.radius) {
    if (!stack_.empty() && !is_near(0)) (void)stack_.pop();
  }

  [[nodiscard]] bool empty() const noexcept { return stack_.empty(); }
  [[nodiscard]] const CellGrid::Cell& pop() noexcept { return cells()[stack_.pop()]; }

  void push_children(const CellGrid::Cell& cell) noexcept {
    std::array<std::pair<float, std::uint32_t>, 8> near;
    std::uint32_t count = 0;
    for (std::uint32_t i = cell.first_child; i < cell.first_child + cell.children; ++i) {
      if (!is_near(i)) continue;
      const std::pair child{test_.squared_distance(cells()[i]), i};
      std::uint32_t at = count++;
      for (; at > 0 && near[at - 1] < child; --at) near[at] = near[at - 1];
      near[at] = child;
    }
    for (std::uint32_t k = 0; k < count; ++k) stack_.push(near[k].second);
  }

 private:
  [[nodiscard]] std::span<const CellGrid::Cell> cells() const noexcept {
    return points_.grid.cells();
  }
  [[nodiscard]] bool is_near(std::uint32_t cell) const noexcept {
    const double reach = std::max<double>(points_.cell_reach[cell], radius_);
    return test_.near(cells()[cell], reach + extra_);
  }

  const SurfacePoints& points_;
  CellTest test_;
  CellStack stack_;
  double radius_;  // R of all points, m; 0: each has its own
  double extra_;   // m
};

/// The most that points of a layer can add to the weight sum anywhere in the ball. Stops at
/// `enough` or when `visits` has run out.
double largest_weight(const ImplicitSurface& surface, const ActiveLayer& layer, const Ball& ball,
                      double radius, double enough, int& visits) noexcept {
  const SurfacePoints& points = *layer.points;
  const PointTest point_test(points, ball.center - points.origin);
  const auto ball_radius = static_cast<float>(ball.radius);
  double total = 0;
  NearCells near(layer, ball, radius);
  visits = std::max(0, visits - 1);  // the root
  while (!near.empty() && visits > 0 && total < enough) {
    const CellGrid::Cell& cell = near.pop();
    if (cell.children > 0) {
      visits = std::max(0, visits - static_cast<int>(cell.children));
      if (visits > 0) near.push_children(cell);
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
