#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "palpate/device/simulated.hpp"
#include "palpate/device/workspace.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate {

/// The surface that is explored. World frame.
struct ExploredSurface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m; points are relative to it
  std::span<const Eigen::Vector3f> points;           ///< m
  std::span<const Eigen::Vector3f> normals;  ///< unit or zero; empty: fitted, away from the middle
};

/// How a hand explores. Lengths and speeds are the world's.
struct ExplorationOptions {
  double duration = 10;        ///< s
  double period = 1e-3;        ///< s between rows
  double radius = 0.01;        ///< R: the length in which the surface is smooth, m; > 0
  double depth = 5e-3;         ///< of the hand's target below the rendered surface while sliding, m
  double offset = 0;           ///< of the rendered surface above the points, m
  double patch = 0.3;          ///< largest extent of the region that is explored, m; > 0
  double slide_speed = 0.1;    ///< m/s
  double travel_speed = 0.25;  ///< m/s, through free space
  std::uint64_t seed = 1;      ///< of the random choice of places and directions
  std::function<void(double)> progress = {};  ///< called with the share done, 0 to 1
};

/// The target of a hand that explores a surface: it comes down along a normal, presses, slides,
/// lifts off, moves to another place through free space (above all obstacles, if there is such a
/// path), and so on until the time is over. Strokes begin where nothing was touched yet and follow
/// the points until they end or the stroke is long enough. Moves begin and end at rest. Clouds
/// larger than `patch` are explored around their median point. Same input, same trajectory; no
/// clock and no thread.
/// @throws Error when there are no points or an option is out of range.
[[nodiscard]] Trajectory explore(const ExploredSurface& surface,
                                 const ExplorationOptions& options = {});

/// The stiffest surface, N/m to the hand, that the simulated hand holds without humming: about
/// b / 1.5 T with its and the device's damping b, half a step of holding and one of delay.
inline constexpr double kSteadyStiffness = 2000;

/// How a hand on a desk explores a scene of any size.
struct ExplorationPlan {
  Workspace workspace;   ///< magnified so that what is explored fits a hand's reach
  double stiffness = 0;  ///< of the surface, N/m in the world
  double patch = 0;      ///< largest extent of what is explored, m
  double depth = 0;      ///< that the hand is meant to reach under the surface, m
  Trajectory target;     ///< where the hand wants to be, device frame
};

struct ExplorationPlanOptions {
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
/// hand's trajectory. @throws Error when the scene has no points or an option is out of its range.
[[nodiscard]] ExplorationPlan plan_exploration(const Scene& scene, const FieldOptions& field,
                                               const ExplorationPlanOptions& options);

/// Where a device is put that does not explore, and the stiffness that goes with it.
struct Placement {
  Workspace workspace;
  double stiffness = 0;  ///< of the surface, N/m in the world
};

/// The device's origin is just outside the surface, 2 mm of the hand in front of it, where it looks
/// up (+z) and is nearest to the vertical through the middle (mean) of all points or, where it
/// looks up nowhere, where it is nearest to that middle; its axes are the world's. Scale and
/// stiffness are those of plan_exploration(), and so are the errors.
[[nodiscard]] Placement place_device(const Scene& scene, const FieldOptions& field,
                                     const ExplorationPlanOptions& options);

/// 1 where a hand can explore `extent` metres as they are, else the fitting one of
/// ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ...
[[nodiscard]] double workspace_scale(double extent);

}  // namespace palpate
