#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "palpate/sensor/simulated_scene.hpp"

namespace palpate {

/// Places in SimulatedTable::scene.solids.
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

/// How many placements of the objects there are.
inline constexpr int kTableLayouts = 3;

/// Everything stands still.
/// @throws Error when there is no such layout.
[[nodiscard]] SimulatedTable make_simulated_table(int layout = 0);

}  // namespace palpate
