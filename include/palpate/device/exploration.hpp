#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>

#include "palpate/io/trajectory.hpp"

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

}  // namespace palpate
