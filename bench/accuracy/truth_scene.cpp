// Makes scenes whose signed distance is known.
#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {

TruthScene make_truth_scene(int layout) {
  const SimulatedTable table = make_simulated_table(layout);
  TruthScene scene;
  for (std::size_t i = 0; i < kTableParts; ++i) scene.solids[i] = table.scene.solids[i].solid;
  scene.camera.T_world_camera = table.T_world_camera;
  scene.slide_center = table.free_patch;
  return scene;
}

TruthScene make_empty_scene() {
  TruthScene scene;
  for (Solid& solid : scene.solids) {
    solid.kind = SolidKind::ball;
    solid.size = Eigen::Vector3d::Constant(1e-3);
    solid.T_world_solid.translation() = Eigen::Vector3d(0, 0, -100);
  }
  return scene;
}

Solid half_space(const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
                 const Eigen::Vector3d& side) {
  Solid solid;
  solid.kind = SolidKind::half_space;
  solid.T_world_solid.linear() << side, normal.cross(side), normal;
  solid.T_world_solid.translation() = place;
  return solid;
}

Distance distance_and_normal(const TruthScene& scene, const Eigen::Vector3d& x) {
  Distance nearest = distance_and_normal(scene.solids[0], x);
  for (std::size_t i = 1; i < scene.solids.size(); ++i) {
    const Distance other = distance_and_normal(scene.solids[i], x);
    if (other.value < nearest.value) nearest = other;
  }
  return nearest;
}

}  // namespace palpate::accuracy
