#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

#include "sim/simulated_depth.hpp"

namespace palpate {

/// Motion of a solid or a camera: a straight line and a turn between two times, and a sine of
/// either, all added up. Turns are about the body's own origin.
struct SimulatedMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();       ///< m/s, from `begin` to `end`
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();          ///< of turns, world frame, unit
  double spin = 0;                                          ///< rad/s, from `begin` to `end`
  double begin = -std::numeric_limits<double>::infinity();  ///< s; before it, as at it
  double end = std::numeric_limits<double>::infinity();     ///< s; after it, as at it
  Eigen::Vector3d swing = Eigen::Vector3d::Zero();          ///< amplitude of a sine, m
  double rock = 0;                                          ///< amplitude of a sine turn, rad
  double frequency = 0;                                     ///< of both sines, Hz
  double phase = 0;                                         ///< of both sines, rad
};

/// Pose at time t (s) of a body that is at `pose` before its motion. The straight line and the turn
/// count from t = 0, or from `begin` where that is finite.
[[nodiscard]] Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const SimulatedMotion& motion,
                                      double t);

/// Velocity of that body at time t and position x, m/s, world.
[[nodiscard]] Eigen::Vector3d velocity(const Eigen::Isometry3d& pose, const SimulatedMotion& motion,
                                       const Eigen::Vector3d& x, double t);

struct SimulatedSolid {
  Solid solid;
  SimulatedMotion motion = {};
};

/// Solids with given motions: what a simulated camera sees, and the truth that what is felt of
/// it is measured against. World frame; may be read by several threads.
struct SimulatedScene {
  std::vector<SimulatedSolid> solids;
};

/// The solids where they are at time t (s).
[[nodiscard]] std::vector<Solid> solids_at(const SimulatedScene& scene, double t);

/// Distance to the nearest solid at time t; exact if x is outside of all. Infinite for a scene
/// without solids.
[[nodiscard]] Distance distance_and_normal(const SimulatedScene& scene, const Eigen::Vector3d& x,
                                           double t);

/// Velocity of the nearest solid at x, m/s, world. Its component along the normal is the speed of
/// the surface.
[[nodiscard]] Eigen::Vector3d surface_velocity(const SimulatedScene& scene,
                                               const Eigen::Vector3d& x, double t);

/// Indices in SimulatedTable::scene.solids.
enum TablePart : std::size_t { kTable, kWall, kSphere, kBox, kCylinder, kPlate, kTableParts };

/// A table-top seen from 0.7 m, 27 degrees from above: a sphere (r 60 mm), a box, an upright
/// cylinder (r 35 mm) and a thin plate that faces the camera, before a wall. World frame: the table
/// is z = 0, z points up, x away from the camera, and the optical axis meets the table at the
/// origin.
struct SimulatedTable {
  SimulatedScene scene;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d free_patch = Eigen::Vector3d::Zero();  ///< middle of table without objects, m
};

/// Number of object placements (judgement).
inline constexpr int kTableLayouts = 3;

/// Everything stands still.
/// @throws Error when there is no such layout.
[[nodiscard]] SimulatedTable make_simulated_table(int layout = 0);

}  // namespace palpate
