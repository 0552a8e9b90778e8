#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/depth/camera_model.hpp"

namespace palpate::depth {

/// Depth images as a lens without distortion would have taken them: each pixel gets what was
/// measured in the nearest pixel of the distorted image, so that inverse depths on planes are
/// affine in pixels again and no two depths are ever mixed. Rows and columns seen twice or not at
/// all shift points by half a pixel at most.
class Undistorter {
 public:
  /// The image without distortion: `depth` itself when the camera has none. Valid until the next
  /// call. Computes its map when the camera is another one than before.
  const float* undistort(const CameraModel& camera, const std::vector<float>& depth);

 private:
  void make_map(const CameraModel& camera);

  std::optional<CameraModel> camera_ = {};
  std::vector<std::int32_t> map_;  // to the distorted image's pixel; -1: outside of it
  std::vector<float> image_;
};

/// Where a camera with `distortion` sees the normalised image coordinates x, y.
struct ImagePoint {
  double x = 0;
  double y = 0;
};
[[nodiscard]] ImagePoint distort(const Distortion& distortion, double x, double y);

}  // namespace palpate::depth
