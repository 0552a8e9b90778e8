#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::accuracy {

/// Sigma at a metre of the worst of depth cameras, m; it grows with the square of the distance.
inline constexpr double kWorstNoise = 5e-3;

/// A pixel that measured something.
struct PatchPixel {
  std::size_t number = 0;
  Eigen::Vector3d at;  ///< in the camera's frame, m
};

/// A flat part, 12 cm wide in either direction of the image, of what a camera sees; in its frame.
struct Patch {
  int u = 0, v = 0;  ///< its middle, pixels
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< to the camera
  std::vector<PatchPixel> pixels;
};

/// Around a pixel at depth `z` (m), not yet turned; without pixels where the frame does not measure
/// nine tenths of them.
[[nodiscard]] Patch patch_at(const DepthFrame& frame, int u, int v, double z);

/// Moves and turns a patch into the plane of its pixels: biweight, Tukey's constant 4. Returns
/// their scale about it, m.
double settle_on_plane(Patch& patch);

/// The patch around a pixel, if the frame shows something flat there: all but 3 % lies on one plane
/// within the noise of any camera, and bends by less than 0.5 mm.
[[nodiscard]] std::optional<Patch> flat_patch(const DepthFrame& frame, int u, int v);

}  // namespace palpate::accuracy
