// Guesses which axis of a scene points up.
#include "viewer/upright.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

namespace {

constexpr std::size_t kEnough = 100'000;  // points; more are thinned out (judgement)
// Points; fewer decide nothing: an even spread has only 20 of these in the foot (judgement)
constexpr std::size_t kFew = 1000;
// Share of the points at either end that may be outliers (judgement)
constexpr double kOutlier = 0.005;
constexpr double kFoot = 0.02;  // share of the height that counts as the foot (judgement)
// Times what an even spread has at the foot, as a ball has at any (Archimedes: the area between two
// planes goes with their distance): then it is flat there.
constexpr double kFlat = 2;

// Points that are felt, or that are to be.
struct Part {
  Eigen::Vector3d origin;
  std::span<const Eigen::Vector3f> points;
  std::shared_ptr<const void> owner;
};

// Relative to some origin.
std::vector<Eigen::Vector3f> some_points(const Scene& scene) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> points = scene.source(i).points();
    const std::shared_ptr<const PointCloud> rest = scene.source(i).state().overview;
    if (points) parts.push_back({points->origin, points->grid.points(), points});
    if (points && rest) parts.push_back({rest->origin, rest->positions, rest});
  }
  std::size_t all = 0;
  for (const Part& part : parts) all += part.points.size();
  const std::size_t every = all / kEnough + 1;
  std::vector<Eigen::Vector3f> some;
  for (const Part& part : parts) {
    const Eigen::Vector3f shift = (part.origin - parts.front().origin).cast<float>();
    for (std::size_t k = 0; k < part.points.size(); k += every) {
      some.push_back(part.points[k] + shift);
    }
  }
  return some;
}

struct Spread {
  double size = 0;  // from end to end
  double low = 0;   // times what an even spread has at the lower end
  double high = 0;  // and at the upper one
};

Spread spread_along(const std::vector<Eigen::Vector3f>& points, int axis) {
  std::vector<float> values;
  values.reserve(points.size());
  for (const Eigen::Vector3f& p : points) values.push_back(p[axis]);
  std::ranges::sort(values);
  const auto outliers = static_cast<std::size_t>(kOutlier * static_cast<double>(values.size()));
  const float lower = values[outliers];
  const float upper = values[values.size() - 1 - outliers];
  const auto foot = static_cast<float>(kFoot) * (upper - lower);
  const auto even = kFoot * static_cast<double>(values.size());
  const auto low = std::ranges::upper_bound(values, lower + foot) - values.begin();
  const auto high = values.end() - std::ranges::lower_bound(values, upper - foot);
  return {upper - lower, static_cast<double>(low) / even, static_cast<double>(high) / even};
}

}  // namespace

Eigen::Vector3d likely_up(const Scene& scene) {
  const std::vector<Eigen::Vector3f> points = some_points(scene);
  if (points.size() < kFew) return Eigen::Vector3d::UnitZ();
  const std::array<Spread, 3> along = {spread_along(points, 0), spread_along(points, 1),
                                       spread_along(points, 2)};
  const auto& [x, y, z] = along;
  // A wall is flat, too, but stands on none of its sides: what stands is not thinnest where it is
  // flat, and flat along one axis only.
  const bool flat = std::max(y.low, y.high) > kFlat && y.size > std::min(x.size, z.size);
  const bool elsewhere = z.low > kFlat || std::max(x.low, x.high) > kFlat;
  if (!flat || elsewhere) return Eigen::Vector3d::UnitZ();
  return y.low >= y.high ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
}

}  // namespace palpate
