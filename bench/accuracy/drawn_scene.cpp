// Draws scenes whose objects are all seen and clear of one another.
#include "accuracy/drawn_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "accuracy/image_outline.hpp"
#include "accuracy/strokes.hpp"
#include "common/stage.hpp"
#include "palpate/base/error.hpp"

namespace palpate::accuracy {
namespace {

using bench::between;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kRoot = 0.05;  // m below the table; derived: as in the fixed layouts
constexpr double kBorder = 12;  // pixels, between what counts and the image's border; judgement
// pixels, between outlines; judgement: no flying pixels reach over
constexpr double kBetween = 10;
constexpr double kGap = 0.04;    // m, between objects on the table; judgement: more than two R
constexpr double kPatch = 0.12;  // m, radius of the free patch; derived: a slide and 20 mm
constexpr double kBesideSlide = 0.025;  // m; judgement: more than R at 0.7 m
// m, from a slide to any object; judgement: more than R at 0.7 m
constexpr double kFromSlide = 0.03;
// m, of table that paths at the cloud's edge go over; judgement: 10 mm more than they need
constexpr double kEdgeStrip = 0.07;
constexpr int kPlaces = 200;   // that are tried for one object; judgement
constexpr int kScenes = 5000;  // judgement

// An occupied place: its outline in the image, and a circle on the table.
struct Place {
  Outline outline;
  Vector3d foot;
  double radius = 0;
};

TruthCamera draw_camera(Random& random) {
  const double distance = between(random, 0.6, 0.8);
  const double down = between(random, 20, 40) * kDegree;
  const double roll = between(random, -5, 5) * kDegree;
  const Vector3d forward(std::cos(down), 0, -std::sin(down));
  const Vector3d right(0, -1, 0);
  TruthCamera camera;
  camera.T_world_camera.linear() << right, forward.cross(right), forward;
  camera.T_world_camera.translation() = -distance * forward;
  camera.T_world_camera.rotate(Eigen::AngleAxisd(roll, Vector3d::UnitZ()));
  return camera;
}

Isometry3d at(double x, double y, double z, double turn = 0) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(x, y, z);
  pose.rotate(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
  return pose;
}

Isometry3d facing(const Vector3d& center, const Vector3d& eye) {
  const Vector3d x = (eye - center).normalized();
  const Vector3d y = Vector3d::UnitZ().cross(x).normalized();
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() << x, y, x.cross(y);
  pose.translation() = center;
  return pose;
}

Solid draw_object(TablePart part, const Vector3d& eye, Random& random) {
  const auto near = [&](double length) { return length * between(random, 0.75, 1.25); };
  const double x = between(random, -0.15, 0.3);
  const double y = between(random, -0.35, 0.35);
  if (part == kSphere) {
    const double r = between(random, 0.04, 0.08);
    return {SolidKind::ball, at(x, y, r), Vector3d::Constant(r)};
  }
  if (part == kCylinder) {
    const double r = near(0.035);
    const double height = near(0.12);
    return {SolidKind::cylinder, at(x, y, (height - kRoot) / 2),
            Vector3d(r, r, (height + kRoot) / 2)};
  }
  const double a = near(part == kBox ? 0.12 : 0.002);
  const double b = near(part == kBox ? 0.10 : 0.12);
  const double c = near(part == kBox ? 0.08 : 0.10);
  if (part == kPlate) {
    return {SolidKind::block, facing(Vector3d(x, y, c / 2), eye), Vector3d(a, b, c) / 2};
  }
  const double turn = between(random, -45, 45) * kDegree;
  return {SolidKind::block, at(x, y, (c - kRoot) / 2, turn), Vector3d(a, b, c + kRoot) / 2};
}

Place place_of(const TruthCamera& camera, const Solid& solid, bool with_foot) {
  std::vector<Vector3d> points = hull_above_table(solid);
  Vector3d foot = solid.T_world_solid.translation();
  foot.z() = 0;
  double radius = 0;
  for (Vector3d point : points) {
    point.z() = 0;
    radius = std::max(radius, (point - foot).norm());
  }
  if (with_foot) {  // the table before it is needed, too
    Solid wider = solid;
    wider.size += Vector3d(kGap, kGap, 0);
    for (Vector3d point : hull_above_table(wider)) {
      points.emplace_back(point.x(), point.y(), 0);
    }
  }
  return {project(camera, points), foot, radius};
}

Place table_place(const TruthCamera& camera, const Vector3d& center, double radius) {
  return {project(camera, circle_on_table(center, radius)), center, radius};
}

bool clear_of(const Place& place, const std::vector<Place>& others) {
  return std::all_of(others.begin(), others.end(), [&](const Place& other) {
    return (place.foot - other.foot).norm() > place.radius + other.radius + kGap &&
           apart(place.outline, other.outline, kBetween);
  });
}

bool draw_object_place(TruthScene& scene, TablePart part, double wall, std::vector<Place>& taken,
                       Random& random) {
  for (int i = 0; i < kPlaces; ++i) {
    const Solid solid = draw_object(part, scene.camera.T_world_camera.translation(), random);
    Place place = place_of(scene.camera, solid, part == kBox);
    if (place.foot.x() + place.radius + kGap > wall) continue;
    if (!inside_image(scene.camera, place.outline, kBorder) || !clear_of(place, taken)) continue;
    scene.solids[part] = solid;
    taken.push_back(std::move(place));
    return true;
  }
  return false;
}

bool draw_patch(TruthScene& scene, const std::vector<Place>& taken, Random& random) {
  for (int i = 0; i < kPlaces; ++i) {
    const double x = between(random, -0.2, 0.1);
    scene.slide_center = {x, between(random, -0.2, 0.2), 0};
    const Place place = table_place(scene.camera, scene.slide_center, kPatch);
    if (inside_image(scene.camera, place.outline, kBorder) && clear_of(place, taken)) return true;
  }
  return false;
}

std::optional<TruthScene> draw_once(Random& random) {
  TruthScene scene;
  scene.camera = draw_camera(random);
  const double wall = between(random, 0.45, 0.7);
  scene.solids[kWall].T_world_solid = at(wall, 0, 0);
  scene.solids[kWall].T_world_solid.rotate(Eigen::AngleAxisd(-90 * kDegree, Vector3d::UnitY()));
  const Vector3d strip = cloud_edge(scene) + Vector3d(kEdgeStrip / 2, 0, 0);
  std::vector<Place> taken = {table_place(scene.camera, strip, kEdgeStrip / 2)};
  for (const TablePart part : {kBox, kSphere, kPlate, kCylinder}) {
    if (!draw_object_place(scene, part, wall, taken, random)) return std::nullopt;
  }
  if (!draw_patch(scene, taken, random)) return std::nullopt;
  return scene;
}

}  // namespace

TruthScene draw_truth_scene(std::uint64_t number) {
  Random random(number);
  for (int i = 0; i < kScenes; ++i) {
    if (const std::optional<TruthScene> scene = draw_once(random)) return *scene;
  }
  throw Error("no scene of layout " + std::to_string(number) + " shows all its objects after " +
              std::to_string(kScenes) + " draws; take another number");
}

bool is_free_table(const TruthScene& scene, const Vector3d& from, const Vector3d& to) {
  std::vector<Vector3d> about = circle_on_table(from, kBesideSlide);
  const std::vector<Vector3d> end = circle_on_table(to, kBesideSlide);
  about.insert(about.end(), end.begin(), end.end());
  const Outline outline = project(scene.camera, about);
  if (!inside_image(scene.camera, outline, kBorder)) return false;
  for (const TablePart part : {kSphere, kBox, kCylinder, kPlate}) {
    const Solid& solid = scene.solids[part];
    if (!apart(outline, project(scene.camera, hull_above_table(solid)), kBetween)) return false;
    for (int i = 0; i <= 20; ++i) {
      if (distance(solid, from + (to - from) * (i / 20.0)) < kFromSlide) return false;
    }
  }
  return distance(scene.solids[kWall], from) > kGap && distance(scene.solids[kWall], to) > kGap;
}

}  // namespace palpate::accuracy
