// Makes the single strokes that rows consist of.
#include "accuracy/strokes.hpp"

#include <cmath>
#include <numbers>

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

constexpr const char* kOffEdge = "off the cloud's edge";
constexpr const char* kFromBehind = "from behind it";
constexpr const char* kAround = "around it";

Path off_edge(const Vector3d& edge) {
  const Vector3d x = Vector3d::UnitX();
  return slide(edge + 0.06 * x, edge - 0.05 * x, Vector3d::UnitZ(), kSlideDepth);
}

Path from_behind(const Vector3d& edge) {
  const Vector3d under = edge + Vector3d(0.03, 0, 0);
  const Vector3d z = Vector3d::UnitZ();
  const Vector3d beside = edge - Vector3d(0.08, 0, 0);
  return PathBuilder(beside - 0.04 * z)
      .line_to(under - 0.04 * z)
      .start_score()
      .line_to(under + 0.004 * z)
      .line_to(under - 0.04 * z)
      .build();
}

// Two turns at 10 mm round the last row of points, in the plane across the edge.
Path around_edge(const Vector3d& edge) {
  const auto at = [=](double t) -> Vector3d {
    const double angle = 4 * std::numbers::pi * t;
    return edge + 0.01 * Vector3d(-std::cos(angle), 0, std::sin(angle));
  };
  return PathBuilder(at(0)).start_score().curve(at, 4 * std::numbers::pi * 0.01).build();
}

}  // namespace

Path slide(const Vector3d& from, const Vector3d& to, const Vector3d& normal, double depth) {
  return PathBuilder(from + kPathClearance * normal)
      .line_to(from - depth * normal)
      .start_score()
      .line_to(to - depth * normal)
      .end_score()
      .line_to(to + kPathClearance * normal)
      .build();
}

Path slide_over(const Solid& half_space, double turn, double length, double depth) {
  const Eigen::Isometry3d& pose = half_space.T_world_solid;
  const Vector3d half = pose.linear() * Vector3d(std::cos(turn), std::sin(turn), 0) * (length / 2);
  const Vector3d place = pose.translation();
  return slide(place - half, place + half, pose.linear().col(2), depth);
}

Vector3d direction_on(const Arc& arc, double t) {
  const double angle = (2 * t - 1) * arc.half;
  return std::cos(angle) * arc.middle + std::sin(angle) * arc.side;
}

Path sphere_arc(const Solid& sphere, const Arc& arc) {
  const Vector3d c = sphere.T_world_solid.translation();
  const double r = sphere.size.x() - kSlideDepth;
  const auto forth = [=](double t) -> Vector3d { return c + r * direction_on(arc, t); };
  const auto back = [=](double t) { return forth(1 - t); };
  const double length = 2 * arc.half * r;
  const Vector3d start = c + (sphere.size.x() + kPathClearance) * direction_on(arc, 0);
  return PathBuilder(start)
      .line_to(forth(0))
      .start_score()
      .curve(forth, length)
      .curve(back, length)
      .end_score()
      .line_to(start)
      .build();
}

Path tap(const Vector3d& place) {
  const Vector3d z = Vector3d::UnitZ();
  return PathBuilder(place + 0.05 * z)
      .start_score()
      .line_to(place - 0.01 * z, 1.0)
      .hold(0.1)
      .line_to(place + 0.05 * z, 1.0)
      .build();
}

Path static_press(const Vector3d& place) {
  const Vector3d z = Vector3d::UnitZ();
  return PathBuilder(place + kPathClearance * z)
      .line_to(place - kSlideDepth * z)
      .start_score()
      .hold(0.5)
      .build();
}

Path thin_push(const Solid& plate, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const auto at = [&](double depth, const Eigen::Vector2d& place) -> Vector3d {
    return plate.T_world_solid * Vector3d(plate.size.x() - depth, place.x(), place.y());
  };
  return PathBuilder(at(-0.02, from))
      .start_score()
      .line_to(at(0.03, from))
      .line_to(at(0.03, to))
      .build();
}

Face face_of(const Solid& box, int axis, double sign) {
  const Eigen::Isometry3d& T = box.T_world_solid;
  Vector3d outward = Vector3d::Zero();
  Vector3d along = Vector3d::Zero();
  outward[axis] = sign;
  along[1 - axis] = 1;
  const Vector3d top = T * Vector3d(outward * box.size[axis] + box.size.z() * Vector3d::UnitZ());
  return {top, Vector3d(top.x(), top.y(), 0), T.linear() * outward, T.linear() * along,
          box.size[1 - axis]};
}

Path crease(const Face& face, double depth, double from, double to) {
  const auto at = [&](double out, double along) -> Vector3d {
    return face.foot + out * (face.normal + Vector3d::UnitZ()) + along * face.along;
  };
  return PathBuilder(at(0.02, from))
      .start_score()
      .line_to(at(-depth, from))
      .line_to(at(-depth, to))
      .line_to(at(0.02, to))
      .build();
}

Vector3d cloud_edge(const TruthScene& scene) {
  const CameraModel& camera = scene.camera.model;
  const Vector3d ray((camera.width / 2 - camera.pinhole.cx) / camera.pinhole.fx,
                     (camera.height - 1 - camera.pinhole.cy) / camera.pinhole.fy, 1);
  const Vector3d eye = scene.camera.T_world_camera.translation();
  const Vector3d direction = scene.camera.T_world_camera.linear() * ray;
  return eye - direction * (eye.z() / direction.z());
}

std::vector<Row> edge_rows(const TruthScene& scene) {
  const Vector3d edge = cloud_edge(scene);
  return {{kOffEdge, {off_edge(edge)}},
          {kFromBehind, {from_behind(edge)}},
          {kAround, {around_edge(edge)}}};
}

bool is_edge_row(const std::string& name) {
  return name == kOffEdge || name == kFromBehind || name == kAround;
}

}  // namespace palpate::accuracy
