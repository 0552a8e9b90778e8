// Makes the paths of table A on a fixed layout.
#include "accuracy/rows.hpp"

#include <cmath>

#include "accuracy/strokes.hpp"
#include "base/numbers.hpp"

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

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

// One arc lies across the line of sight, one in it; both on the side that the camera sees.
std::vector<Path> sphere_slides(const TruthScene& scene) {
  const Solid& sphere = scene.solids[kSphere];
  Vector3d view = scene.camera.T_world_camera.translation() - sphere.T_world_solid.translation();
  view.z() = 0;
  view.normalize();
  const Vector3d middle =
      std::cos(60 * kDegree) * view + std::sin(60 * kDegree) * Vector3d::UnitZ();
  const Vector3d across = Vector3d::UnitZ().cross(view);
  return {sphere_arc(sphere, {middle, across, 30 * kDegree}),
          sphere_arc(sphere, {middle, middle.cross(across), 30 * kDegree})};
}

// The face of the box that looks at the camera.
Face front_face(const TruthScene& scene) {
  return face_of(scene.solids[kBox], 0, -1);
}

// 50 mm on the top and off over the edge; 50 mm in the face, upwards and off over the same edge.
std::vector<Path> box_edges(const TruthScene& scene) {
  const Face face = front_face(scene);
  const Vector3d z = Vector3d::UnitZ();
  const Vector3d in_top = face.top - 0.05 * face.normal;
  const Vector3d in_face = face.top - 0.05 * z;
  return {slide(in_top, face.top + 0.02 * face.normal, z, kSlideDepth),
          slide(in_face, face.top + 0.02 * z, face.normal, kSlideDepth)};
}

// Five places, since a single one would measure luck.
std::vector<Path> fast_taps(const TruthScene& scene) {
  std::vector<Path> taps;
  for (const auto& [dx, dy] :
       {std::pair{0.0, 0.0}, {0.08, 0.0}, {-0.08, 0.0}, {0.0, 0.08}, {0.0, -0.08}}) {
    taps.push_back(tap(scene.slide_center + Vector3d(dx, dy, 0)));
  }
  return taps;
}

}  // namespace

std::vector<Row> make_rows(const TruthScene& scene) {
  std::vector<Row> rows = {{"plane slide", plane_slides(scene, kSlideDepth)},
                           {"light slide", plane_slides(scene, kLightDepth)},
                           {"sphere slide", sphere_slides(scene)},
                           {"box edge", box_edges(scene)},
                           {"fast tap", fast_taps(scene)},
                           {"thin push", {thin_push(scene.solids[kPlate], {-0.01, 0}, {0.01, 0})}},
                           {"static press", {static_press(scene.slide_center)}},
                           {"crease 10 mm", {crease(front_face(scene), 0.01, -0.02, 0.02)}}};
  for (Row& row : edge_rows(scene)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace palpate::accuracy
