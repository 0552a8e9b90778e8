#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate::viewer {

/// Message 2 of docs/viewer_protocol.md. Places relative to the origin, m. Optional columns are
/// empty or as long as `places`.
struct CloudMessage {
  std::uint8_t source = 0;
  double stamp = 0;  ///< s
  std::vector<Eigen::Vector3f> places;
  std::vector<std::array<std::uint8_t, 3>> colors = {};
  std::vector<Eigen::Vector3f> normals = {};
  std::vector<std::uint8_t> trust = {};  ///< SurfacePoints::confidences, 255 for 1
};

[[nodiscard]] std::string encode(const CloudMessage& message);

}  // namespace palpate::viewer
