#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "palpate/device/simulated.hpp"
#include "palpate/device/workspace.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::app {

/// The stiffest surface, N/m to the hand, that the simulated hand holds without humming: about
/// b / 1.5 T with its and the device's damping b, half a step of holding and one of delay.
inline constexpr double kStiffest = 2000;

/// How a hand on a desk explores a scene of any size.
struct ExplorationPlan {
  Workspace workspace;   ///< magnified so that what is explored fits a hand's reach
  double stiffness = 0;  ///< of the surface, N/m in the world
  double patch = 0;      ///< largest extent of what is explored, m
  double depth = 0;      ///< that the hand is meant to reach under the surface, m
  Trajectory target;     ///< where the hand wants to be, device frame
};

struct PlanOptions {
  std::optional<double> scale = {};  ///< of the workspace; unset: chosen
  double duration = 10;              ///< s
  double stiffness = 0;              ///< N/m in the world; 0: 500 at the hand
  double tool_radius = 0;            ///< m
  std::uint64_t seed = 1;
  SimulatedDeviceOptions::Hand hand = {};
  double rate = 1000;                         ///< steps a second
  std::function<void(double)> progress = {};  ///< called with the share (0 to 1) that is planned
};

/// Chooses scale, patch, depth and speeds from the scene's extent and support radius, and plans the
/// hand's way. @throws Error when the scene has no points.
[[nodiscard]] ExplorationPlan plan_exploration(const Scene& scene, const FieldOptions& field,
                                               const PlanOptions& options);

/// Where a device stands that nobody leads, and the stiffness that goes with it.
struct Stand {
  Workspace workspace;
  double stiffness = 0;  ///< of the surface, N/m in the world
};

/// The device's origin is just outside the surface, 2 mm of the hand in front of it, where it looks
/// up (+z) and is nearest to the vertical through the middle (mean) of all points or, where it
/// looks up nowhere, where it is nearest to that middle; its axes are the world's. Scale and
/// stiffness are those of plan_exploration(). @throws Error when the scene has no points.
[[nodiscard]] Stand plan_stand(const Scene& scene, const FieldOptions& field,
                               const PlanOptions& options);

/// 1 where a hand can explore `extent` metres as they are, else the fitting one of
/// ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ...
[[nodiscard]] double workspace_scale(double extent);

}  // namespace palpate::app
