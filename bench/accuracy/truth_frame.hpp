#pragma once

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "sim/simulated_noise.hpp"

/// Frames of a scene with known truth, exact and noisy, and their points.
namespace palpate::accuracy {

struct TruthScene;

/// The frame of the scene's camera without any error.
[[nodiscard]] DepthFrame exact_frame(const TruthScene& scene);

/// The same frame with the camera's errors.
[[nodiscard]] DepthFrame noisy_frame(const DepthFrame& exact, const SimulatedNoiseOptions& noise);

/// Every measured pixel as a point in the camera's frame, whose viewpoint is its origin.
[[nodiscard]] PointCloud back_project(const DepthFrame& frame);

}  // namespace palpate::accuracy
