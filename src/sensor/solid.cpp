#include "palpate/sensor/solid.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Distance to_ball(const Vector3d& x, double radius) {
  const double r = x.norm();
  return {r - radius, r > 0 ? Vector3d(x / r) : Vector3d::UnitZ()};
}

// q: how far x is beyond each pair of faces (negative: inside them).
Distance to_block(const Vector3d& x, const Vector3d& half) {
  const Vector3d q = x.cwiseAbs() - half;
  const Vector3d sign = (x.array() < 0).select(Vector3d::Constant(-1), Vector3d::Ones());
  const Vector3d beyond = q.cwiseMax(0);
  const double outside = beyond.norm();
  if (outside > 0) return {outside, beyond.cwiseProduct(sign) / outside};
  Eigen::Index axis = 0;
  const double inside = q.maxCoeff(&axis);
  Vector3d normal = Vector3d::Zero();
  normal[axis] = sign[axis];
  return {inside, normal};
}

Distance to_cylinder(const Vector3d& x, double radius, double half_height) {
  const double r = std::hypot(x.x(), x.y());
  const Vector3d radial = r > 0 ? Vector3d(x.x() / r, x.y() / r, 0) : Vector3d::UnitX();
  const Vector3d axial(0, 0, x.z() < 0 ? -1 : 1);
  const Vector2d q(r - radius, std::abs(x.z()) - half_height);
  const Vector2d beyond = q.cwiseMax(0);
  const double outside = beyond.norm();
  if (outside > 0) return {outside, (beyond.x() * radial + beyond.y() * axial) / outside};
  return q.x() > q.y() ? Distance{q.x(), radial} : Distance{q.y(), axial};
}

Distance local_distance(const Solid& solid, const Vector3d& x) {
  switch (solid.kind) {
    case SolidKind::ball:
      return to_ball(x, solid.size.x());
    case SolidKind::block:
      return to_block(x, solid.size);
    case SolidKind::cylinder:
      return to_cylinder(x, solid.size.x(), solid.size.z());
    case SolidKind::half_space:
      break;
  }
  return {x.z(), Vector3d::UnitZ()};
}

}  // namespace

Distance distance_and_normal(const Solid& solid, const Vector3d& x) {
  const Eigen::Matrix3d rotation = solid.T_world_solid.linear();
  const Vector3d local = rotation.transpose() * (x - solid.T_world_solid.translation());
  const Distance found = local_distance(solid, local);
  return {found.value, rotation * found.gradient};
}

double distance(const Solid& solid, const Vector3d& x) {
  return distance_and_normal(solid, x).value;
}

}  // namespace palpate
