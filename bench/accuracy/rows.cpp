#include "accuracy/rows.hpp"

#include <cmath>
#include <numbers>

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kDepth = 3e-3;  // of slides, m
constexpr double kLightDepth = 5e-4;
constexpr double kClearance = 0.01;  // above the surface, where paths begin and end
constexpr double kDegree = std::numbers::pi / 180;

// Along one straight line at constant depth below a plane of the given outward normal.
Path slide(const Vector3d& from, const Vector3d& to, const Vector3d& normal, double depth) {
  return PathBuilder(from + kClearance * normal)
      .line_to(from - depth * normal)
      .start_score()
      .line_to(to - depth * normal)
      .end_score()
      .line_to(to + kClearance * normal)
      .build();
}

// Away from the camera, towards it and across.
std::vector<Path> plane_slides(const TruthScene& scene, double depth) {
  const Vector3d c = scene.slide_center;
  const Vector3d x(0.1, 0, 0);
  const Vector3d y(0, 0.1, 0);
  const Vector3d z = Vector3d::UnitZ();
  const Vector3d beside = 0.2 * y;
  return {slide(c - x, c + x, z, depth), slide(c + x + beside, c - x + beside, z, depth),
          slide(c - y, c + y, z, depth)};
}

// There and back over 60 degrees of a great circle through `middle`, towards `side`.
Path sphere_arc(const Solid& sphere, const Vector3d& middle, const Vector3d& side) {
  const Vector3d c = sphere.T_world_solid.translation();
  const double r = sphere.size.x() - kDepth;
  const auto direction = [=](double t) -> Vector3d {
    const double angle = (60 * t - 30) * kDegree;
    return std::cos(angle) * middle + std::sin(angle) * side;
  };
  const auto forth = [=](double t) -> Vector3d { return c + r * direction(t); };
  const auto back = [=](double t) { return forth(1 - t); };
  const double length = 60 * kDegree * r;
  const Vector3d start = c + (sphere.size.x() + kClearance) * direction(0);
  return PathBuilder(start)
      .line_to(forth(0))
      .start_score()
      .curve(forth, length)
      .curve(back, length)
      .end_score()
      .line_to(start)
      .build();
}

// One arc lies across the line of sight, one in it; both on the side that the camera sees.
std::vector<Path> sphere_slides(const TruthScene& scene) {
  const Solid& sphere = scene.solids[kSphere];
  Vector3d view = scene.camera.T_world_camera.translation() - sphere.T_world_solid.translation();
  view.z() = 0;
  view.normalize();
  const Vector3d middle =
      std::cos(60 * kDegree) * view + std::sin(60 * kDegree) * Vector3d::UnitZ();
  const Vector3d across = Vector3d::UnitZ().cross(view);
  return {sphere_arc(sphere, middle, across), sphere_arc(sphere, middle, middle.cross(across))};
}

// The face of the box that looks at the camera.
struct Face {
  Vector3d top;   // middle of its upper edge
  Vector3d foot;  // middle of its lower edge
  Vector3d normal;
  Vector3d along;  // horizontal, along the edges
};

Face front_face(const Solid& box) {
  const Eigen::Isometry3d& T = box.T_world_solid;
  const Vector3d& half = box.size;
  const Vector3d top = T * Vector3d(-half.x(), 0, half.z());
  return {top, Vector3d(top.x(), top.y(), 0), T.linear() * Vector3d(-1, 0, 0),
          T.linear() * Vector3d(0, 1, 0)};
}

// 50 mm on the top and off over the edge; 50 mm in the face, upwards and off over the same edge.
std::vector<Path> box_edges(const TruthScene& scene) {
  const Face face = front_face(scene.solids[kBox]);
  const Vector3d z = Vector3d::UnitZ();
  const Vector3d in_top = face.top - 0.05 * face.normal;
  const Vector3d in_face = face.top - 0.05 * z;
  return {slide(in_top, face.top + 0.02 * face.normal, z, kDepth),
          slide(in_face, face.top + 0.02 * z, face.normal, kDepth)};
}

// Five places, since a single one would measure luck.
std::vector<Path> fast_taps(const TruthScene& scene) {
  std::vector<Path> taps;
  const Vector3d z = Vector3d::UnitZ();
  for (const auto& [dx, dy] :
       {std::pair{0.0, 0.0}, {0.08, 0.0}, {-0.08, 0.0}, {0.0, 0.08}, {0.0, -0.08}}) {
    const Vector3d place = scene.slide_center + Vector3d(dx, dy, 0);
    taps.push_back(PathBuilder(place + 0.05 * z)
                       .start_score()
                       .line_to(place - 0.01 * z, 1.0)
                       .hold(0.1)
                       .line_to(place + 0.05 * z, 1.0)
                       .build());
  }
  return taps;
}

Path thin_push(const TruthScene& scene) {
  const Solid& plate = scene.solids[kPlate];
  const auto at = [&](double depth, double along) -> Vector3d {
    return plate.T_world_solid * Vector3d(plate.size.x() - depth, along, 0);
  };
  return PathBuilder(at(-0.02, -0.01))
      .start_score()
      .line_to(at(0.03, -0.01))
      .line_to(at(0.03, 0.01))
      .build();
}

Path static_press(const TruthScene& scene) {
  const Vector3d z = Vector3d::UnitZ();
  return PathBuilder(scene.slide_center + kClearance * z)
      .line_to(scene.slide_center - kDepth * z)
      .start_score()
      .hold(0.5)
      .build();
}

// 10 mm into the table and 10 mm into the box at once, 40 mm along the foot, and out.
Path crease(const TruthScene& scene) {
  const Face face = front_face(scene.solids[kBox]);
  const auto at = [&](double out, double along) -> Vector3d {
    return face.foot + out * (face.normal + Vector3d::UnitZ()) + along * face.along;
  };
  return PathBuilder(at(0.02, -0.02))
      .start_score()
      .line_to(at(-0.01, -0.02))
      .line_to(at(-0.01, 0.02))
      .line_to(at(0.02, 0.02))
      .build();
}

// The cloud ends where the table leaves the image at its lower border, between the camera and the
// slides. The truth goes on there, so that these rows tell of steps and attraction alone.
Vector3d cloud_edge(const TruthScene& scene) {
  const CameraModel& camera = scene.camera.model;
  const Vector3d ray((camera.width / 2 - camera.pinhole.cx) / camera.pinhole.fx,
                     (camera.height - 1 - camera.pinhole.cy) / camera.pinhole.fy, 1);
  const Vector3d eye = scene.camera.T_world_camera.translation();
  const Vector3d direction = scene.camera.T_world_camera.linear() * ray;
  return eye - direction * (eye.z() / direction.z());
}

Path off_edge(const Vector3d& edge) {
  const Vector3d x = Vector3d::UnitX();
  return slide(edge + 0.06 * x, edge - 0.05 * x, Vector3d::UnitZ(), kDepth);
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

std::vector<Row> make_rows(const TruthScene& scene) {
  const Vector3d edge = cloud_edge(scene);
  return {{"plane slide", plane_slides(scene, kDepth)},
          {"light slide", plane_slides(scene, kLightDepth)},
          {"sphere slide", sphere_slides(scene)},
          {"box edge", box_edges(scene)},
          {"fast tap", fast_taps(scene)},
          {"thin push", {thin_push(scene)}},
          {"static press", {static_press(scene)}},
          {"crease 10 mm", {crease(scene)}},
          {"off the cloud's edge", {off_edge(edge)}},
          {"from behind it", {from_behind(edge)}},
          {"around it", {around_edge(edge)}}};
}

}  // namespace palpate::accuracy
