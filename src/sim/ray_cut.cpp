#include "sim/ray_cut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = 1e-300;

// A ray is inside of a convex solid from `enter` to `leave`; never, if these are out of order.
struct Stretch {
  double enter = -kInfinity;
  double leave = kInfinity;
};

Stretch both(const Stretch& a, const Stretch& b) {
  return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

constexpr Stretch kNever{kInfinity, -kInfinity};

// Between the planes at -half and half.
Stretch cut_slab(double from, double along, double half) {
  const double slope = 1 / (std::abs(along) < kTiny ? kTiny : along);
  const double a = (-half - from) * slope;
  const double b = (half - from) * slope;
  return {std::min(a, b), std::max(a, b)};
}

// Where a t^2 + 2 b t + c <= 0.
Stretch cut_quadric(double a, double b, double c) {
  if (a < kTiny) return c <= 0 ? Stretch{} : kNever;
  const double square = b * b - a * c;
  if (square < 0) return kNever;
  const double root = std::sqrt(square);
  return {(-b - root) / a, (-b + root) / a};
}

struct HalfSpaceCut {
  Stretch operator()(const Vector3d& from, const Vector3d& along) const {
    if (from.z() <= 0 || along.z() >= 0) return kNever;
    return {-from.z() / along.z(), kInfinity};
  }
};

struct BallCut {
  double radius;
  Stretch operator()(const Vector3d& from, const Vector3d& along) const {
    return cut_quadric(along.squaredNorm(), from.dot(along), from.squaredNorm() - radius * radius);
  }
};

struct BlockCut {
  Vector3d half;
  Stretch operator()(const Vector3d& from, const Vector3d& along) const {
    return both(
        both(cut_slab(from.x(), along.x(), half.x()), cut_slab(from.y(), along.y(), half.y())),
        cut_slab(from.z(), along.z(), half.z()));
  }
};

struct CylinderCut {
  double radius;
  double half_height;
  Stretch operator()(const Vector3d& from, const Vector3d& along) const {
    const auto f = from.head<2>();
    const auto d = along.head<2>();
    return both(cut_quadric(d.squaredNorm(), f.dot(d), f.squaredNorm() - radius * radius),
                cut_slab(from.z(), along.z(), half_height));
  }
};

template <class Cut>
void cut_row(const Cut& cut, const Eigen::Isometry3d& T_solid_camera, const RayRow& rays) {
  const Vector3d from = T_solid_camera.translation();
  const Eigen::Matrix3d turn = T_solid_camera.linear();
  for (std::size_t i = 0; i < rays.count; ++i) {
    const Vector3d along = turn * Vector3d(rays.x[i], rays.y[i], 1);
    const Stretch inside = cut(from, along);
    // From within a solid nothing of it is seen.
    const bool seen = inside.enter > 0 && inside.enter <= inside.leave;
    const float depth = seen ? static_cast<float>(inside.enter) : rays.depth[i];
    rays.depth[i] = std::min(rays.depth[i], depth);
  }
}

}  // namespace

void cut_rays(const Solid& solid, const Eigen::Isometry3d& T_solid_camera, const RayRow& rays) {
  switch (solid.kind) {
    case SolidKind::half_space:
      return cut_row(HalfSpaceCut{}, T_solid_camera, rays);
    case SolidKind::ball:
      return cut_row(BallCut{solid.size.x()}, T_solid_camera, rays);
    case SolidKind::block:
      return cut_row(BlockCut{solid.size}, T_solid_camera, rays);
    case SolidKind::cylinder:
      return cut_row(CylinderCut{solid.size.x(), solid.size.z()}, T_solid_camera, rays);
  }
}

}  // namespace palpate
