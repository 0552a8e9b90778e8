#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/depth/camera_model.hpp"

namespace palpate {

/// One image of a depth camera. Depth in 16 bits is put into it by to_metres().
struct DepthFrame {
  CameraModel camera;
  double stamp = 0;  ///< when it was taken, s, on the host's clock
  std::optional<Eigen::Isometry3d>
      T_world_sensor;        ///< at the stamp; unset: where the source stands
  std::vector<float> depth;  ///< along the optical axis, m, row by row; 0: nothing measured
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< of the same pixels; may be empty
};

}  // namespace palpate
