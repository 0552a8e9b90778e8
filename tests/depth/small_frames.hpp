#pragma once

#include <vector>

#include "depth/blocks.hpp"
#include "depth/shapes.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "sim/simulated_depth.hpp"
#include "sim/simulated_noise.hpp"

namespace palpate::test {

/// The middle of a 640 x 480 image.
inline constexpr CameraModel kSmall{160, 120, {525, 525, 79.5, 59.5}, {}};

inline DepthFrame exact_frame(const std::vector<Solid>& solids,
                              const CameraModel& camera = kSmall) {
  DepthFrame frame;
  frame.camera = camera;
  DepthRenderer(camera).render(solids, Eigen::Isometry3d::Identity(), frame.depth);
  return frame;
}

inline DepthFrame noisy_frame(const std::vector<Solid>& solids, const SimulatedNoiseOptions& noise,
                              std::uint64_t number = 0, const CameraModel& camera = kSmall) {
  DepthFrame frame = exact_frame(solids, camera);
  SimulatedNoise(noise).apply(camera.width, camera.height, number, frame.depth);
  return frame;
}

/// Blocks as the filter makes them.
inline depth::Blocks blocks_of(const DepthFrame& frame, const NoiseModel& noise) {
  depth::Blocks blocks;
  blocks.resize(depth::block_grid(frame.camera));
  depth::average_blocks(frame.depth.data(), frame.camera.width, noise, {}, blocks);
  depth::reject_flying(noise, blocks);
  return blocks;
}

}  // namespace palpate::test
