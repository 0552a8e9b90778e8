#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "any_cloud/draft.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::any_cloud {

/// A draft brought into the world: turned, moved, in some unit, maybe with survey coordinates.
struct HostileScene {
  PointCloud cloud;
  std::vector<HandTick> ticks;
  Shape truth;           ///< empty: nobody knows
  double spacing = 1;    ///< what one spacing of the draft is in the cloud's unit
  double stiffness = 1;  ///< 0.5 N a spacing, in N per unit
  double deep = 0;       ///< as in Draft
  double clear = 0;
  Eigen::Isometry3d T_world_draft = Eigen::Isometry3d::Identity();
};

inline constexpr double kNewtonsPerSpacing = 0.5;  ///< 500 N/m at a spacing of 1 mm
inline constexpr double kRadius = 2.5;             ///< R that is expected, spacings

/// One kind of scene; a seed makes a scene of it.
struct Row {
  std::string family;
  std::string name;
  std::function<void(Draft&)> draw;
};

/// The seed decides layout, noise, way, pose and unit: metres at a spacing of 1 mm, the same in
/// millimetres or feet, or in metres with coordinates as of a survey.
[[nodiscard]] HostileScene make_scene(const Row& row, std::uint64_t seed);

/// The truth at a place in the world: distance in spacings, gradient in the draft's frame.
[[nodiscard]] Distance true_surface(const HostileScene& scene, const Eigen::Vector3d& x);

/// The distance alone.
[[nodiscard]] double true_distance(const HostileScene& scene, const Eigen::Vector3d& x);

}  // namespace palpate::any_cloud
