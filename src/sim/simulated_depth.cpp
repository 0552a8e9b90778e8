// Renders exact depth images of scenes made of convex solids.
#include "sim/simulated_depth.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "palpate/base/error.hpp"

namespace palpate {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = 1e-300;

// Pixels beside one another: their rays (x, y, 1) in the camera's frame, and the nearest depth so
// far.
struct RayRow {
  const double* x = nullptr;
  const double* y = nullptr;
  float* depth = nullptr;
  std::size_t count = 0;
};

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

// Stretch where a t^2 + 2 b t + c <= 0.
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
    // A camera inside a solid sees nothing of it.
    const bool seen = inside.enter > 0 && inside.enter <= inside.leave;
    const float depth = seen ? static_cast<float>(inside.enter) : rays.depth[i];
    rays.depth[i] = std::min(rays.depth[i], depth);
  }
}

// Lowers the depths of rays that enter the solid nearer than what they have met so far.
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

namespace {

constexpr int kUndistortSteps = 50;
constexpr double kUndistorted = 1e-12;  // error of a ray, of a unit of depth

Vector2d distorted(const CameraModel::Distortion& d, const Vector2d& p) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  return {x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
          y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y};
}

// A fixed point: what distortion adds is small and changes slowly.
Vector2d undistorted(const CameraModel::Distortion& d, const Vector2d& image) {
  Vector2d p = image;
  for (int i = 0; i < kUndistortSteps; ++i) {
    const Vector2d error = distorted(d, p) - image;
    if (error.norm() < kUndistorted) return p;
    p -= error;
  }
  throw Error(
      fmt::format("the distortion of a simulated camera cannot be inverted at ({:.3f}, {:.3f}); "
                  "give smaller coefficients",
                  image.x(), image.y()));
}

// Pixels that may see a solid: columns u0 ... u1 - 1, rows v0 ... v1 - 1.
struct Window {
  int u0 = 0;
  int u1 = 0;
  int v0 = 0;
  int v1 = 0;
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

// x / z over a disc around (x, z): where the lines from the origin touch it.
Range slopes(double x, double z, double radius) {
  const double reach = z * z - radius * radius;
  if (z <= radius) return {};
  const double root = radius * std::sqrt(x * x + reach);
  return {(x * z - root) / reach, (x * z + root) / reach};
}

int pixel(double value, int limit) {
  return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
}

double reach_of(const Solid& solid) {
  if (solid.kind == SolidKind::ball) return solid.size.x();
  if (solid.kind == SolidKind::cylinder) return std::hypot(solid.size.x(), solid.size.z());
  return solid.size.norm();
}

Window window_of(const CameraModel& camera, const Solid& solid, const Vector3d& center) {
  const Window all{0, camera.width, 0, camera.height};
  if (solid.kind == SolidKind::half_space || !camera.distortion.none()) return all;
  const double radius = reach_of(solid);
  const Range x = slopes(center.x(), center.z(), radius);
  const Range y = slopes(center.y(), center.z(), radius);
  const Pinhole& p = camera.pinhole;
  return {pixel(std::floor(p.cx + p.fx * x.low), camera.width),
          pixel(std::ceil(p.cx + p.fx * x.high) + 1, camera.width),
          pixel(std::floor(p.cy + p.fy * y.low), camera.height),
          pixel(std::ceil(p.cy + p.fy * y.high) + 1, camera.height)};
}

void check(const CameraModel& camera) {
  const bool whole =
      camera.width > 0 && camera.height > 0 && camera.pinhole.fx > 0 && camera.pinhole.fy > 0;
  if (!whole) {
    throw Error(
        fmt::format("a simulated camera of {} x {} pixels with focal lengths {:g}, {:g} "
                    "sees nothing; all four must be positive",
                    camera.width, camera.height, camera.pinhole.fx, camera.pinhole.fy));
  }
}

}  // namespace

DepthRenderer::DepthRenderer(const CameraModel& camera, double farthest)
    : camera_(camera), farthest_(farthest) {
  check(camera);
  const Pinhole& p = camera.pinhole;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector2d image((u - p.cx) / p.fx, (v - p.cy) / p.fy);
      const Vector2d ray = camera.distortion.none() ? image : undistorted(camera.distortion, image);
      x_.push_back(ray.x());
      y_.push_back(ray.y());
    }
  }
}

void DepthRenderer::render(std::span<const Solid> solids, const Eigen::Isometry3d& T_world_camera,
                           std::vector<float>& depth) const {
  const float none = std::numeric_limits<float>::infinity();
  depth.assign(x_.size(), none);
  for (const Solid& solid : solids) {
    const Eigen::Isometry3d T_solid_camera =
        solid.T_world_solid.inverse(Eigen::Isometry) * T_world_camera;
    const Vector3d center = T_solid_camera.inverse(Eigen::Isometry).translation();
    const Window w = window_of(camera_, solid, center);
    for (int v = w.v0; v < w.v1; ++v) {
      const std::size_t row = static_cast<std::size_t>(v) * camera_.width;
      const std::size_t count = static_cast<std::size_t>(std::max(0, w.u1 - w.u0));
      const RayRow rays{&x_[row + w.u0], &y_[row + w.u0], &depth[row + w.u0], count};
      cut_rays(solid, T_solid_camera, rays);
    }
  }
  for (float& z : depth) z = z > farthest_ ? 0 : z;
}

}  // namespace palpate
