#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "palpate/device/device.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate {

/// The stiffest surface, N/m to the hand, that the simulated hand holds without humming: about
/// b / 1.5 T with its and the device's damping b, half a step of holding and one of delay.
inline constexpr double kSteadyStiffness = 2000;

/// Placement of a device in a scene of any size: its workspace, the stiffness that goes with it,
/// and the trajectory of its hand if that explores.
struct Placement {
  Workspace workspace;   ///< magnified so that what is explored fits a hand's reach
  double stiffness = 0;  ///< of the surface, N/m in the world
  double region = 0;     ///< largest extent of what is explored, m
  double depth = 0;      ///< that a hand that explores is meant to reach under the surface, m
  Trajectory target;  ///< where such a hand wants to be, device frame; empty: it does not explore
  std::vector<Press> presses = {};  ///< of that trajectory
  double force = 0;                 ///< N that such a hand has to pull with at most
};

struct ExplorationOptions {
  std::optional<double> scale = {};  ///< of the workspace; unset: chosen
  double duration = 10;              ///< s
  double stiffness = 0;              ///< N/m in the world; 0: 500 at the hand
  double tool_radius = 0;            ///< m
  std::vector<Ball> tool = {};       ///< a tool that turns, from its handle on, m
  std::uint64_t seed = 1;
  SimulatedDeviceOptions::Hand hand = {};
  double rate = 1000;                         ///< steps a second
  std::function<void(double)> progress = {};  ///< called with the share (0 to 1) that is planned
};

/// Chooses scale, region, depth and speeds from the scene's extent and support radius, and plans
/// the hand's trajectory. @throws Error when the scene has no points or an option is out of its
/// range.
[[nodiscard]] Placement plan_exploration(const Scene& scene, const FieldOptions& field,
                                         const ExplorationOptions& options);

/// The device's origin is just outside the surface, 2 mm of the hand in front of it, where it looks
/// up (+z) and is nearest to the vertical through the middle (mean) of all points or, where it
/// looks up nowhere, where it is nearest to that middle; its axes are the world's. Scale and
/// stiffness are those of plan_exploration(), and so are the errors.
[[nodiscard]] Placement place_device(const Scene& scene, const FieldOptions& field,
                                     const ExplorationOptions& options);

}  // namespace palpate
