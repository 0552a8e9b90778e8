#include "palpate/sensor/simulated_scene.hpp"

#include <limits>

namespace palpate {
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

}  // namespace palpate
