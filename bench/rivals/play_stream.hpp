#pragma once

#include <functional>
#include <vector>

#include "rivals/rival.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::rivals {

/// One simulated camera and a hand, in simulated time.
struct Streamed {
  const SimulatedScene& scene;
  const SimulatedCameraOptions& camera;
  const std::vector<Eigen::Vector3d>& hip;  ///< m, world, tick by tick
  double latency = 0.01;                    ///< from a frame's stamp until it is felt, s
  /// Spoils a frame on its way; false: it never arrives. Unset: all arrive as they are.
  std::function<bool(DepthFrame&)> fault = {};
};

struct Played {
  std::vector<std::vector<Step>> steps;  ///< of each method, tick by tick
  std::vector<std::size_t> swaps;        ///< ticks in which a frame is felt first
};

/// Plays methods at once on the same frames, each of which replaces the one before.
[[nodiscard]] Played play_stream(const Streamed& streamed, const std::vector<Method>& methods);

}  // namespace palpate::rivals
