// Exact shapes and their unions: the truth beside drawn clouds.
#include "any_cloud/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::any_cloud {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A proxy cannot leave a crease below 90 degrees that is perfectly sharp: either side's normal
// there points into the other side.
constexpr double kFillet = 0.1;
constexpr double kOnEdge = 1e-9;  // nearer to an edge, the way to it is rounding

// How far x is from a place, less a radius.
Distance around(const Vector3d& from_place, double radius) {
  const double norm = from_place.norm();
  return {norm - radius, norm > 0 ? Vector3d(from_place / norm) : Vector3d::UnitZ()};
}

}  // namespace

Shape half_space(const Vector3d& point, const Vector3d& outward) {
  return [point, normal = outward.normalized()](const Vector3d& x) {
    return Distance{normal.dot(x - point), normal};
  };
}

Shape of(const Solid& solid) {
  return [solid](const Vector3d& x) { return distance_and_normal(solid, x); };
}

Shape ball(double radius) {
  return [radius](const Vector3d& x) { return around(x, radius); };
}

Shape box(const Vector3d& center, const Vector3d& size) {
  Solid solid{SolidKind::block, Eigen::Isometry3d::Identity(), size / 2};
  solid.T_world_solid.translation() = center;
  return of(solid);
}

Shape rod(const Vector3d& a, const Vector3d& b, double radius) {
  return [a, way = Vector3d(b - a), radius](const Vector3d& x) {
    const double along = std::clamp((x - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    return around(x - a - along * way, radius);
  };
}

Shape torus(double ring, double tube) {
  return [ring, tube](const Vector3d& x) {
    const Vector3d flat(x.x(), x.y(), 0);
    const double norm = flat.norm();
    const Vector3d middle = norm > 0 ? Vector3d(flat * (ring / norm)) : Vector3d(ring, 0, 0);
    return around(x - middle, tube);
  };
}

Shape extruded(std::vector<Vector2d> polygon) {
  return [polygon = std::move(polygon)](const Vector3d& x) {
    const Vector2d here(x.x(), x.z());
    double nearest = std::numeric_limits<double>::infinity();
    Vector2d from_edge = Vector2d::UnitX();
    Vector2d outward = Vector2d::UnitX();
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d& a = polygon[i];
      const Vector2d& b = polygon[(i + 1) % polygon.size()];
      const Vector2d way = b - a;
      const double along = std::clamp((here - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
      const Vector2d off = here - a - along * way;
      if (off.norm() < nearest) {
        nearest = off.norm();
        from_edge = off;
        outward = Vector2d(way.y(), -way.x()).normalized();
      }
      const bool crosses = (a.y() > here.y()) != (b.y() > here.y());
      if (crosses && here.x() < a.x() + way.x() * (here.y() - a.y()) / way.y()) inside = !inside;
    }
    const double sign = inside ? -1 : 1;
    if (nearest > kOnEdge) outward = sign * from_edge / nearest;
    return Distance{sign * nearest, Vector3d(outward.x(), 0, outward.y())};
  };
}

Shape unite(Shape a, Shape b) {
  return [a = std::move(a), b = std::move(b)](const Vector3d& x) {
    const Distance da = a(x);
    const Distance db = b(x);
    const double share = std::clamp(0.5 + 0.5 * (da.value - db.value) / kFillet, 0.0, 1.0);
    return Distance{da.value + share * (db.value - da.value) - kFillet * share * (1 - share),
                    da.gradient + share * (db.gradient - da.gradient)};
  };
}

}  // namespace palpate::any_cloud
