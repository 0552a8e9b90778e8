// Projects objects into the image and compares their outlines.
#include "accuracy/image_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::accuracy {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCirclePoints = 16;  // of a circle; judgement
constexpr int kDirections = 32;    // that two outlines are told apart along; judgement
// radii; derived: above 1 / cos(pi / 16) and what a ball's rings miss
constexpr double kBulge = 1.06;

double angle(int i, int n) {
  return 2 * std::numbers::pi * i / n;
}

// The farthest that the outline reaches along a direction.
double reach(const Outline& outline, const Vector2d& direction) {
  double most = direction.dot(outline.front());
  for (const Vector2d& point : outline) most = std::max(most, direction.dot(point));
  return most;
}

std::vector<Vector3d> local_hull(const Solid& solid) {
  const Vector3d& s = solid.size;
  std::vector<Vector3d> points;
  for (const double z : {-1.0, -0.8, -0.5, 0.0, 0.5, 0.8, 1.0}) {
    const bool ball = solid.kind == SolidKind::ball;
    const double width = kBulge * (ball ? std::sqrt(1 - z * z) : 1.0);
    for (int i = 0; i < kCirclePoints; ++i) {
      const double c = width * std::cos(angle(i, kCirclePoints));
      const double v = width * std::sin(angle(i, kCirclePoints));
      points.emplace_back(s.x() * c, s.y() * v, s.z() * (ball ? kBulge * z : z));
    }
    if (solid.kind != SolidKind::block) continue;
    points.erase(points.end() - kCirclePoints, points.end());
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) points.emplace_back(s.x() * x, s.y() * y, s.z() * z);
    }
  }
  return points;
}

}  // namespace

Outline project(const TruthCamera& camera, const std::vector<Vector3d>& points) {
  const Pinhole& pinhole = camera.model.pinhole;
  const Eigen::Isometry3d T_camera_world = camera.T_world_camera.inverse();
  Outline outline;
  for (const Vector3d& point : points) {
    const Vector3d at = T_camera_world * point;
    outline.emplace_back(pinhole.cx + pinhole.fx * at.x() / at.z(),
                         pinhole.cy + pinhole.fy * at.y() / at.z());
  }
  return outline;
}

std::vector<Vector3d> hull_above_table(const Solid& solid) {
  std::vector<Vector3d> points = local_hull(solid);
  for (Vector3d& point : points) {
    point = solid.T_world_solid * point;
    point.z() = std::max(point.z(), 0.0);
  }
  return points;
}

std::vector<Vector3d> circle_on_table(const Vector3d& center, double radius) {
  std::vector<Vector3d> points;
  for (int i = 0; i < kCirclePoints; ++i) {
    const double a = angle(i, kCirclePoints);
    points.emplace_back(center.x() + radius * std::cos(a), center.y() + radius * std::sin(a), 0);
  }
  return points;
}

bool inside_image(const TruthCamera& camera, const Outline& outline, double margin) {
  return std::all_of(outline.begin(), outline.end(), [&](const Vector2d& p) {
    return p.x() >= margin && p.x() <= camera.model.width - 1 - margin && p.y() >= margin &&
           p.y() <= camera.model.height - 1 - margin;
  });
}

bool apart(const Outline& a, const Outline& b, double margin) {
  for (int i = 0; i < kDirections; ++i) {
    const double t = angle(i, kDirections);
    const Vector2d direction(std::cos(t), std::sin(t));
    if (reach(a, direction) + margin <= -reach(b, -direction)) return true;
  }
  return false;
}

}  // namespace palpate::accuracy
