#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/numbers.hpp"
#include "depth/noise_tracker.hpp"
#include "depth/shapes.hpp"
#include "sim/simulated_depth.hpp"
#include "sim/simulated_noise.hpp"

namespace palpate::test {

inline constexpr CameraModel kKinect{640, 480, {525, 525, 319.5, 239.5}, {}};

inline constexpr double kDepths[] = {0.5, 0.6, 0.7, 0.85, 1.0};  ///< where sigma is compared, m
inline const NoiseModel kTruth = kinect_like_noise();
inline constexpr double kBlurred = 7.1;  ///< c of NoiseKind::blurred

/// The camera of the simulated frames in its own frame: z forward.
inline depth::DepthView view_of(const std::vector<float>& image,
                                const CameraModel& camera = kKinect) {
  return {image, camera.width, camera.height, camera.pinhole.fx, 0.1F, 20.0F};
}

/// A table under a camera that looks down 27 degrees, 0.7 m away, and a wall behind it.
inline std::vector<Solid> table_and_wall() {
  const double tilt = 27 * std::numbers::pi / 180;
  const Eigen::Vector3d up(0, -std::cos(tilt), -std::sin(tilt));
  const Eigen::Vector3d back(0, std::sin(tilt), -std::cos(tilt));
  return {plane({0, 0, 0.7}, up), plane(Eigen::Vector3d(0, 0, 0.7) - 0.5 * back, back)};
}

/// The same with balls of 3 to 7 cm all over it.
inline std::vector<Solid> clutter(int balls) {
  std::vector<Solid> solids = table_and_wall();
  Random random(1);
  for (int i = 0; i < balls; ++i) {
    const double z = 0.5 + 0.5 * random.uniform();
    const double x = 1.2 * z * (random.uniform() - 0.5);
    const double y = 0.9 * z * (random.uniform() - 0.5);
    solids.push_back(sphere({x, y, z}, 0.03 + 0.04 * random.uniform()));
  }
  return solids;
}

inline std::vector<float> exact_image(const std::vector<Solid>& solids,
                                      const CameraModel& camera = kKinect) {
  std::vector<float> image;
  DepthRenderer(camera).render(solids, Eigen::Isometry3d::Identity(), image);
  return image;
}

/// Frame number `frame` of a camera with this noise.
inline std::vector<float> noisy_image(std::vector<float> exact,
                                      const SimulatedNoiseOptions& options, std::uint64_t frame = 0,
                                      const CameraModel& camera = kKinect) {
  SimulatedNoise(options).apply(camera.width, camera.height, frame, exact);
  return exact;
}

}  // namespace palpate::test
