#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "sim/simulated_camera.hpp"

namespace palpate::events {

inline constexpr double kTick = 1e-3;  ///< s
inline constexpr double kK = 500;      ///< N/m

/// What is seen, by what camera, and where a hand is, tick by tick; tick 0 is the scene's time 0.
struct Event {
  SimulatedScene scene;
  SimulatedCameraOptions camera;
  std::vector<Eigen::Vector3d> hip;  ///< m
  std::size_t begin = 0;             ///< tick at which things begin to happen, and scores
  double depth = 0;        ///< that the hand should be held at, m; 0: nothing should hold it
  bool when_deep = false;  ///< only while it is that deep in what stands still
  /// Spoils a frame on its way; false: it never arrives. Unset: all arrive as they are.
  std::function<bool(DepthFrame&)> fault = {};
  bool as_points = false;  ///< frames are pushed as clouds
};

/// What a hand felt.
struct Felt {
  std::vector<Eigen::Vector3d> force;  ///< N
  std::vector<Eigen::Vector3d> proxy;  ///< m
  std::vector<bool> touching;
};

/// Plays the event in simulated time with the default way of feeling a depth stream.
[[nodiscard]] Felt play(const Event& event);

}  // namespace palpate::events
