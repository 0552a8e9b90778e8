#pragma once

#include <array>

#include "palpate/depth/depth_frame.hpp"
#include "sim/simulated_scene.hpp"

/// Scenes whose signed distance is known, and the camera that sees them.
namespace palpate::accuracy {

struct TruthCamera {
  CameraModel model{640, 480, {525, 525, 319.5, 239.5}, {}};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// The scene of table A: SimulatedTable, standing still, with the camera that sees it.
struct TruthScene {
  std::array<Solid, kTableParts> solids;  ///< in the order of TablePart
  TruthCamera camera;
  Eigen::Vector3d slide_center = Eigen::Vector3d::Zero();  ///< of a free patch of table, m
};

/// Layout 0 is the bench's own, the others are for checking that nothing was tuned to it.
/// @throws palpate::Error when there is no such layout.
[[nodiscard]] TruthScene make_truth_scene(int layout = 0);

/// One with nothing in it and the camera at the world's origin: what has to be there is a speck a
/// hundred metres behind it.
[[nodiscard]] TruthScene make_empty_scene();

/// All behind a plane through `place` (m) that faces along `normal`; `side` is its own x. Both
/// unit, at a right angle.
[[nodiscard]] Solid half_space(const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& side);

/// To the nearest solid: exact wherever x is outside of all of them.
[[nodiscard]] Distance distance_and_normal(const TruthScene& scene, const Eigen::Vector3d& x);

}  // namespace palpate::accuracy
