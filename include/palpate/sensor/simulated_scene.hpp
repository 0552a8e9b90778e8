#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "palpate/sensor/simulated_motion.hpp"
#include "palpate/sensor/solid.hpp"

namespace palpate {

struct SimulatedSolid {
  Solid solid;
  SimulatedMotion motion = {};
};

/// Solids that move in known ways: what a simulated camera sees, and the truth that what is felt of
/// it is measured against. World frame; may be read by several threads.
struct SimulatedScene {
  std::vector<SimulatedSolid> solids;
};

/// The solids where they are at time t (s).
[[nodiscard]] std::vector<Solid> solids_at(const SimulatedScene& scene, double t);

/// To the nearest solid at time t: exact wherever x is outside of all of them. A scene without
/// solids is infinitely far away.
[[nodiscard]] Distance distance_and_normal(const SimulatedScene& scene, const Eigen::Vector3d& x,
                                           double t);

/// How fast the nearest solid moves where x is, m/s, world. Its part along the normal is the speed
/// of the surface.
[[nodiscard]] Eigen::Vector3d surface_velocity(const SimulatedScene& scene,
                                               const Eigen::Vector3d& x, double t);

}  // namespace palpate
