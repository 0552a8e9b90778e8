#pragma once

#include <array>
#include <cstddef>

#include "accuracy/depth_camera.hpp"
#include "accuracy/solid.hpp"

namespace palpate::accuracy {

/// Places in TruthScene::solids.
enum Part : std::size_t { kTable, kWall, kSphere, kBox, kCylinder, kPlate, kParts };

/// The scene of evaluation.md. World frame: the table is z = 0, z points up, x away from the
/// camera, and the optical axis meets the table at the origin.
struct TruthScene {
  std::array<Solid, kParts> solids;
  DepthCamera camera;
  Eigen::Vector3d slide_center = Eigen::Vector3d::Zero();  ///< of a free patch of table, m
};

/// How many placements of the objects there are: the first is the bench's own, the others are for
/// checking that nothing was tuned to it.
inline constexpr int kLayouts = 3;

/// @throws palpate::Error when there is no such layout.
[[nodiscard]] TruthScene make_truth_scene(int layout = 0);

/// To the nearest solid: exact wherever x is outside of all of them.
[[nodiscard]] Distance distance_and_normal(const TruthScene& scene, const Eigen::Vector3d& x);

}  // namespace palpate::accuracy
