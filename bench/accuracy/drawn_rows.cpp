// Draws the paths of table A on a drawn scene.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "accuracy/drawn_scene.hpp"
#include "accuracy/strokes.hpp"
#include "common/stage.hpp"
#include "palpate/base/error.hpp"

namespace palpate::accuracy {
namespace {

using bench::between;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kDraws = 20000;  // judgement: a path that needs more has no room
// arbitrary: scenes and paths draw from streams of their own
constexpr std::uint64_t kPathSeed = 0x9a7b5;
constexpr double kSlideLength = 0.2;  // m; derived: as in the fixed rows
constexpr double kRun = 0.05;  // m, towards an edge of the box; derived: as in the fixed rows
constexpr double kOff = 0.02;  // m, and past it; derived: as in the fixed rows
constexpr double kSteepestArc = 75 * kDegree;   // rad; judgement: beyond it little is measured
constexpr double kSteepestFace = 75 * kDegree;  // rad; judgement: beyond it little is measured
constexpr double kFromCorner = 0.012;           // m; judgement: a slide crosses one edge alone
constexpr double kCrease = 0.04;                // m; derived: the length in the fixed rows

// Draws until `found` says that it did.
void draw_until(const char* what, const std::function<bool()>& found) {
  for (int i = 0; i < kDraws; ++i) {
    if (found()) return;
  }
  throw Error(std::string("the drawn layout has no room for a ") + what + "; take another number");
}

Vector3d draw_on_table(Random& random) {
  const double x = between(random, -0.2, 0.15);
  return {x, between(random, -0.25, 0.25), 0};
}

Vector3d draw_free_place(const TruthScene& scene, Random& random) {
  Vector3d place;
  draw_until("tap", [&] {
    place = draw_on_table(random);
    return is_free_table(scene, place, place);
  });
  return place;
}

std::vector<Path> drawn_slides(const TruthScene& scene, double depth, Random& random) {
  std::vector<Path> slides;
  for (int i = 0; i < 3; ++i) {
    Vector3d from;
    Vector3d to;
    draw_until("slide", [&] {
      const Vector3d middle = draw_on_table(random);
      const double angle = between(random, 0, 2 * std::numbers::pi);
      const Vector3d half = kSlideLength / 2 * Vector3d(std::cos(angle), std::sin(angle), 0);
      from = middle - half;
      to = middle + half;
      return is_free_table(scene, from, to);
    });
    slides.push_back(slide(from, to, Vector3d::UnitZ(), depth));
  }
  return slides;
}

double incidence(const TruthScene& scene, const Vector3d& place, const Vector3d& normal) {
  const Vector3d view = scene.camera.T_world_camera.translation() - place;
  return std::acos(std::clamp(normal.dot(view.normalized()), -1.0, 1.0));
}

bool seen_on_sphere(const TruthScene& scene, const Arc& arc) {
  const Solid& sphere = scene.solids[kSphere];
  for (int i = 0; i <= 20; ++i) {
    const Vector3d normal = direction_on(arc, i / 20.0);
    const Vector3d place = sphere.T_world_solid.translation() + sphere.size.x() * normal;
    if (incidence(scene, place, normal) > kSteepestArc) return false;
  }
  return true;
}

std::vector<Path> drawn_arcs(const TruthScene& scene, Random& random) {
  const Solid& sphere = scene.solids[kSphere];
  const Vector3d view =
      scene.camera.T_world_camera.translation() - sphere.T_world_solid.translation();
  const double facing = std::atan2(view.y(), view.x());
  std::vector<Path> arcs;
  for (int i = 0; i < 2; ++i) {
    const double tilt = between(random, 20, 70) * kDegree;
    Arc arc;
    draw_until("slide on the sphere", [&] {
      const double about = facing + between(random, -40, 40) * kDegree;
      const double turn = between(random, 0, 2 * std::numbers::pi);
      const Vector3d out(std::cos(about), std::sin(about), 0);
      const Vector3d across = Vector3d::UnitZ().cross(out);
      arc.middle = std::cos(tilt) * out + std::sin(tilt) * Vector3d::UnitZ();
      arc.side = std::cos(turn) * across + std::sin(turn) * arc.middle.cross(across);
      arc.half = between(random, 20, 40) * kDegree;
      return seen_on_sphere(scene, arc);
    });
    arcs.push_back(sphere_arc(sphere, arc));
  }
  return arcs;
}

double height_of(const Face& face) {
  return face.top.z();
}

Vector3d middle_of(const Face& face) {
  return 0.5 * (face.top + face.foot);
}

// The upright faces that are seen well, the one that is seen best first.
std::vector<Face> faces_seen(const TruthScene& scene) {
  std::vector<std::pair<double, Face>> all;
  for (const int axis : {0, 1}) {
    for (const double sign : {-1.0, 1.0}) {
      const Face face = face_of(scene.solids[kBox], axis, sign);
      all.emplace_back(incidence(scene, middle_of(face), face.normal), face);
    }
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Face> seen;
  for (const auto& [angle, face] : all) {
    if (angle < kSteepestFace) seen.push_back(face);
  }
  return seen;
}

// Towards an edge and off it, in the plane of the given normal. The edge passes `start`, runs along
// `edge`, and is left in the direction `away`, up to 30 degrees to either side; `low` and `high`
// bound the path along it.
struct Crossing {
  Vector3d start, edge, away, normal;
  double low, high, run;
};

Path drawn_crossing(const Crossing& at, Random& random) {
  double place = 0;
  double angle = 0;
  const auto inside = [&](double along) { return at.low <= along && along <= at.high; };
  draw_until("way over an edge", [&] {
    place = between(random, at.low, at.high);
    angle = between(random, -30, 30) * kDegree;
    return inside(place - at.run * std::sin(angle));
  });
  const Vector3d on_edge = at.start + place * at.edge;
  const Vector3d d = std::cos(angle) * at.away + std::sin(angle) * at.edge;
  return slide(on_edge - at.run * d, on_edge + kOff * d, at.normal, kSlideDepth);
}

std::vector<Path> drawn_edges(const TruthScene& scene, Random& random) {
  const std::vector<Face> faces = faces_seen(scene);
  const Face& front = faces.at(0);
  const Vector3d z = Vector3d::UnitZ();
  const double half = front.half - kFromCorner;
  const double up = std::min(kRun, height_of(front) - 0.03);
  std::vector<Path> paths = {
      drawn_crossing({front.top, front.along, front.normal, z, -half, half, kRun}, random),
      drawn_crossing({front.top, front.along, z, front.normal, -half, half, up}, random)};
  if (faces.size() < 2) return paths;
  const Face& side = faces[1];
  const Vector3d corner = front.foot + front.half * side.normal;
  const double highest = height_of(front) - kFromCorner;
  for (const auto& [on, past] : {std::pair(front, side), std::pair(side, front)}) {
    paths.push_back(
        drawn_crossing({corner, z, past.normal, on.normal, 0.03, highest, kRun}, random));
  }
  return paths;
}

Path drawn_push(const Solid& plate, Random& random) {
  const Vector2d room(plate.size.y() - 0.012, plate.size.z() - 0.012);
  Vector2d from;
  Vector2d to;
  draw_until("push", [&] {
    from.x() = between(random, -room.x(), room.x());
    from.y() = between(random, -room.y(), room.y());
    const double angle = between(random, 0, 2 * std::numbers::pi);
    to = from + 0.02 * Vector2d(std::cos(angle), std::sin(angle));
    return std::abs(to.x()) <= room.x() && std::abs(to.y()) <= room.y();
  });
  return thin_push(plate, from, to);
}

Path drawn_crease(const TruthScene& scene, double depth, Random& random) {
  const Face front = faces_seen(scene).at(0);
  const double room = front.half - kCrease / 2 - 0.008;
  const double middle = between(random, -room, room);
  const double way = random.uniform() < 0.5 ? kCrease : -kCrease;
  return crease(front, depth, middle - way / 2, middle + way / 2);
}

std::vector<Path> drawn_taps(const TruthScene& scene, Random& random) {
  std::vector<Path> taps;
  for (int i = 0; i < 5; ++i) taps.push_back(tap(draw_free_place(scene, random)));
  return taps;
}

}  // namespace

std::vector<Row> draw_rows(const TruthScene& scene, std::uint64_t number) {
  Random random(number ^ kPathSeed << 32);
  std::vector<Row> rows = {{"plane slide", drawn_slides(scene, kSlideDepth, random)},
                           {"light slide", drawn_slides(scene, kLightDepth, random)},
                           {"sphere slide", drawn_arcs(scene, random)},
                           {"box edge", drawn_edges(scene, random)},
                           {"fast tap", drawn_taps(scene, random)},
                           {"thin push", {drawn_push(scene.solids[kPlate], random)}},
                           {"static press", {static_press(draw_free_place(scene, random))}},
                           {"crease 3 mm", {drawn_crease(scene, 0.003, random)}},
                           {"crease 10 mm", {drawn_crease(scene, 0.01, random)}}};
  for (Row& row : edge_rows(scene)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace palpate::accuracy
