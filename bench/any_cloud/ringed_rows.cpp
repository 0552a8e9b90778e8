// Rows of what a spinning lidar saw: rings on a road and on the wall that it leads to.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"
#include "base/numbers.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 40 * kDegree;         // of the view to either side
constexpr double kFarthest = 100;              // m
constexpr double kFieldOfView = 45 * kDegree;  // upright, at most
constexpr int kRings = 3;                      // to either side of a place that is touched

/// A lidar at (0, 0, height) over the road z = 0, that looks along x at a wall. m, rad.
struct Lidar {
  Lidar(Draft& draft, int rings)
      : beams(rings),
        step(draft.between(0.2 * kDegree, std::min(2 * kDegree, kFieldOfView / rings))),
        turn(draft.between(0.1, 0.4) * kDegree),
        height(draft.between(1, 2.2)),
        wall(draft.between(5, 30)),
        top(draft.between(0, 0.4) * step * (rings - 1)) {}

  /// Where a beam meets road or wall, `off` (m) farther along its ray.
  [[nodiscard]] std::optional<Vector3d> point(int ring, double azimuth, double off = 0) const {
    const double elevation = top - step * ring;
    const Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    double range = wall / ray.x();
    if (ray.z() < 0) range = std::min(range, -height / ray.z());
    if (range > kFarthest) return {};
    return Vector3d(0, 0, height) + (range + off) * ray;
  }
  [[nodiscard]] bool meets_wall(int ring, double azimuth) const {
    const std::optional<Vector3d> at = point(ring, azimuth);
    return at && at->x() > wall - 1e-6;
  }

  int beams;
  double step, turn, height, wall, top;
};

/// A place on a ring, between others of its kind; what is its normal, and the distance of rings.
struct Place {
  Vector3d at, normal;
  double gap = 0;
};

std::optional<Place> draw_place(Draft& draft, const Lidar& lidar) {
  const bool on_wall = draft.random.uniform() < 0.5;
  const double azimuth = draft.between(-0.6, 0.6) * kSide;
  const int ring = static_cast<int>(draft.between(kRings, lidar.beams - kRings));
  for (int k = ring - kRings; k <= ring + kRings; ++k) {
    if (!lidar.point(k, azimuth) || lidar.meets_wall(k, azimuth) != on_wall) return {};
  }
  Place place{*lidar.point(ring, azimuth),
              on_wall ? Vector3d(-Vector3d::UnitX()) : Vector3d::UnitZ()};
  place.gap = (*lidar.point(ring - 1, azimuth) - place.at).norm();
  return place;
}

Place place_of(Draft& draft, const Lidar& lidar) {
  constexpr int kTries = 1000;  // lidars that see enough rings of one thing need a few
  for (int i = 0; i < kTries; ++i) {
    if (const std::optional<Place> place = draw_place(draft, lidar)) return *place;
  }
  // The wall straight ahead, whose rings may be few.
  const Vector3d at(lidar.wall, 0, lidar.height);
  return {at, -Vector3d::UnitX(), lidar.wall * std::tan(lidar.step)};
}

/// A spacing of the draft is the side of the squares whose holes are as wide as those between rings
/// where the hand touches.
void draw_rings(Draft& draft, int beams) {
  const Lidar lidar(draft, beams);
  const Place place = place_of(draft, lidar);
  const double spacing = place.gap / std::numbers::sqrt2;
  const double noise = draft.between(0.005, 0.02);
  const double bias = draft.between(0, 0.01);  // of each ring, m
  for (int ring = 0; ring < beams; ++ring) {
    const double of_ring = bias * draft.random.normal();
    double azimuth = -kSide + lidar.turn * draft.random.uniform();
    for (; azimuth < kSide; azimuth += lidar.turn) {
      const std::optional<Vector3d> at =
          lidar.point(ring, azimuth, of_ring + noise * draft.random.normal());
      const Vector3d normal =
          lidar.meets_wall(ring, azimuth) ? Vector3d(-Vector3d::UnitX()) : Vector3d::UnitZ();
      if (at) draft.add((*at - place.at) / spacing, normal);
    }
  }
  const Vector3d on_wall = (Vector3d(lidar.wall, 0, 0) - place.at) / spacing;
  const Vector3d on_road(0, 0, -place.at.z() / spacing);
  draft.truth =
      unite(half_space(on_wall, -Vector3d::UnitX()), half_space(on_road, Vector3d::UnitZ()));
  draft.deep += noise / spacing;
  draft.clear += 2 * noise / spacing;
  constexpr double kDeep = 1.25;  // spacings: half of R
  constexpr double kLong = 5;     // spacings: 2 R
  for (int i = 0; i < 8; ++i) {
    const Vector3d across = place.normal.cross(draft.direction()).normalized();
    const double deep = kDeep + 2 * noise / spacing;
    const Vector3d from = -kLong / 2 * across - deep * place.normal;
    const Vector3d to = kLong / 2 * across - deep * place.normal;
    draft.hand.start(from + 12 * place.normal).to(from, kPush).to(to, kSlide);
    draft.hand.to(to + 12 * place.normal, kPush);
  }
}

}  // namespace

void add_ringed_rows(std::vector<Row>& rows) {
  for (const int beams : {16, 32, 64}) {
    rows.push_back(
        {"rings", fmt::format("rings {}", beams), [=](Draft& draft) { draw_rings(draft, beams); }});
  }
}

}  // namespace palpate::any_cloud
