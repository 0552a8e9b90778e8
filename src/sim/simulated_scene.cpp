// Scenes of moving solids: poses and velocities at a time, and the table that layouts draw.
#include "sim/simulated_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/numbers.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// For how long the straight line and the turn have gone on at time t.
double elapsed(const SimulatedMotion& motion, double t) {
  const double from = std::isfinite(motion.begin) ? motion.begin : 0;
  return std::clamp(t, motion.begin, motion.end) - from;
}

double sine_angle(const SimulatedMotion& motion, double t) {
  return 2 * std::numbers::pi * motion.frequency * t + motion.phase;
}

}  // namespace

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const SimulatedMotion& motion, double t) {
  const double time = elapsed(motion, t);
  const double sine = std::sin(sine_angle(motion, t));
  const Eigen::AngleAxisd turn(motion.spin * time + motion.rock * sine, motion.axis);
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = turn.toRotationMatrix() * pose.linear();
  out.translation() = pose.translation() + motion.velocity * time + motion.swing * sine;
  return out;
}

Eigen::Vector3d velocity(const Eigen::Isometry3d& pose, const SimulatedMotion& motion,
                         const Eigen::Vector3d& x, double t) {
  const double on = t >= motion.begin && t <= motion.end ? 1 : 0;
  const double rate = 2 * std::numbers::pi * motion.frequency * std::cos(sine_angle(motion, t));
  const Eigen::Vector3d turning = (on * motion.spin + rate * motion.rock) * motion.axis;
  const Eigen::Vector3d arm = x - moved(pose, motion, t).translation();
  return on * motion.velocity + rate * motion.swing + turning.cross(arm);
}

namespace {

Solid solid_at(const SimulatedSolid& moving, double t) {
  Solid solid = moving.solid;
  solid.T_world_solid = moved(solid.T_world_solid, moving.motion, t);
  return solid;
}

struct Nearest {
  Distance distance;
  const SimulatedSolid* solid = nullptr;
};

Nearest nearest_solid(const SimulatedScene& scene, const Eigen::Vector3d& x, double t) {
  Nearest nearest;
  nearest.distance.value = std::numeric_limits<double>::infinity();
  for (const SimulatedSolid& moving : scene.solids) {
    const Distance found = distance_and_normal(solid_at(moving, t), x);
    if (found.value < nearest.distance.value) nearest = {found, &moving};
  }
  return nearest;
}

}  // namespace

std::vector<Solid> solids_at(const SimulatedScene& scene, double t) {
  std::vector<Solid> solids;
  solids.reserve(scene.solids.size());
  for (const SimulatedSolid& moving : scene.solids) solids.push_back(solid_at(moving, t));
  return solids;
}

Distance distance_and_normal(const SimulatedScene& scene, const Eigen::Vector3d& x, double t) {
  return nearest_solid(scene, x, t).distance;
}

Eigen::Vector3d surface_velocity(const SimulatedScene& scene, const Eigen::Vector3d& x, double t) {
  const SimulatedSolid* solid = nearest_solid(scene, x, t).solid;
  if (!solid) return Eigen::Vector3d::Zero();
  return velocity(solid->solid.T_world_solid, solid->motion, x, t);
}

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTableDistance = 0.7;  // m along the optical axis (judgement)
constexpr double kLookDown = 27 * kDegree;
constexpr double kSphereRadius = 0.060;
constexpr double kCylinderRadius = 0.035;
constexpr double kCylinderHeight = 0.12;
constexpr double kRoot =
    0.05;  // how far what stands on the table goes on below it: a crease is no edge
constexpr double kPlateElevation = 0.05;  // of the plate's middle above the table
const Vector3d kBoxSize(0.12, 0.10, 0.08);
const Vector3d kPlateSize(0.002, 0.12, 0.10);

// Feet of the objects on the table, m, and how the box is turned. All are clear of one another, of
// their shadows in the camera's view and of the slides.
struct Layout {
  Eigen::Vector2d sphere, box, cylinder, plate, slide;
  double box_turn;
  double wall;
};

Layout layout_of(int number) {
  switch (number) {
    case 0:
      return {{0.02, 0.24}, {0.03, -0.24}, {0.24, 0.14}, {0.22, -0.03},
              {-0.04, 0.0}, -20 * kDegree, 0.50};
    case 1:
      return {{-0.02, -0.22}, {0.06, 0.20},  {0.20, -0.02}, {0.25, -0.17},
              {-0.05, 0.0},   -20 * kDegree, 0.55};
    case 2:
      return {{0.12, -0.02}, {-0.02, -0.22}, {0.30, 0.11}, {0.18, 0.27},
              {-0.07, 0.18}, 20 * kDegree,   0.60};
    default:
      throw Error("unknown layout " + std::to_string(number) +
                  " of the simulated table; give 0 to " + std::to_string(kTableLayouts - 1));
  }
}

Isometry3d camera_pose() {
  const double c = std::cos(kLookDown);
  const double s = std::sin(kLookDown);
  Isometry3d pose = Isometry3d::Identity();
  const Vector3d forward(c, 0, -s);
  const Vector3d right(0, -1, 0);
  pose.linear().col(0) = right;
  pose.linear().col(1) = forward.cross(right);
  pose.linear().col(2) = forward;
  pose.translation() = -kTableDistance * forward;
  return pose;
}

Isometry3d upright(const Eigen::Vector2d& foot, double height, double turn = 0) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Vector3d(foot.x(), foot.y(), height);
  return pose;
}

// Local x points at the camera, local y is horizontal.
Isometry3d facing(const Vector3d& center, const Vector3d& camera) {
  Isometry3d pose = Isometry3d::Identity();
  const Vector3d x = (camera - center).normalized();
  const Vector3d y = Vector3d::UnitZ().cross(x).normalized();
  pose.linear().col(0) = x;
  pose.linear().col(1) = y;
  pose.linear().col(2) = x.cross(y);
  pose.translation() = center;
  return pose;
}

Isometry3d wall_pose(double x) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(-90 * kDegree, Vector3d::UnitY()).toRotationMatrix();
  pose.translation() = Vector3d(x, 0, 0);
  return pose;
}

}  // namespace

SimulatedTable make_simulated_table(int layout) {
  const Layout at = layout_of(layout);
  SimulatedTable table;
  table.T_world_camera = camera_pose();
  table.free_patch = Vector3d(at.slide.x(), at.slide.y(), 0);
  const Vector3d plate(at.plate.x(), at.plate.y(), kPlateElevation);
  auto& solids = table.scene.solids;
  solids.resize(kTableParts);
  solids[kWall].solid = {SolidKind::half_space, wall_pose(at.wall), Vector3d::Zero()};
  solids[kSphere].solid = {SolidKind::ball, upright(at.sphere, kSphereRadius),
                           Vector3d::Constant(kSphereRadius)};
  solids[kBox].solid = {SolidKind::block, upright(at.box, (kBoxSize.z() - kRoot) / 2, at.box_turn),
                        (kBoxSize + kRoot * Vector3d::UnitZ()) / 2};
  solids[kCylinder].solid = {
      SolidKind::cylinder, upright(at.cylinder, (kCylinderHeight - kRoot) / 2),
      Vector3d(kCylinderRadius, kCylinderRadius, (kCylinderHeight + kRoot) / 2)};
  solids[kPlate].solid = {SolidKind::block, facing(plate, table.T_world_camera.translation()),
                          kPlateSize / 2};
  return table;
}

}  // namespace palpate
