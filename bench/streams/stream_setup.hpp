#pragma once

#include <vector>

#include "accuracy/path.hpp"
#include "accuracy/truth_scene.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::streams {

using accuracy::kTick;

/// A scene, its cameras and the hand's path. Ticks are 1 ms; tick 0 is the scene's time 0.
struct Setup {
  SimulatedScene scene;
  std::vector<SimulatedCameraOptions> cameras;
  accuracy::Path path;
  double latency = 0.010;  ///< from a frame's stamp to the start of its surface, s
  double speed = 0;        ///< of the surface, m/s
  double depth = 0;        ///< of the hand in the true surface while it is scored, m
  std::size_t rest = 0;    ///< tick at which a surface that comes begins to move
};

/// How frames come.
struct Frames {
  NoiseKind noise = NoiseKind::independent;
  std::uint64_t seed = 1;
  bool silhouettes = true;
  double jitter = 0;   ///< s
  double seconds = 2;  ///< that are scored, where the path does not say
};

/// 3 mm into the free table.
[[nodiscard]] Setup static_press(const Frames& frames);

/// Both arcs of table A's sphere slide, one after the other is the caller's: `arc` is 0 or 1.
[[nodiscard]] Setup sphere_slide(const Frames& frames, int arc);

/// The table's plane comes along its normal at `speed` (m/s); the hand stays 25 mm deep in it.
[[nodiscard]] Setup plane_comes(const Frames& frames, double speed);

/// A ball of 60 mm comes along the optical axis before a wall; the hand stays 25 mm deep in it.
[[nodiscard]] Setup ball_comes(const Frames& frames, double speed);

/// The press while the camera moves at up to 5 cm/s and 10 degrees/s with its pose known.
[[nodiscard]] Setup camera_moves(const Frames& frames);

/// A second camera sees the table from 60 degrees to the side; what it believes of its pose is off
/// by 3 mm and 0.5 degrees. The hand slides over the table and over the sphere (`part` 0 and 1).
[[nodiscard]] Setup two_cameras(const Frames& frames, int part);

}  // namespace palpate::streams
