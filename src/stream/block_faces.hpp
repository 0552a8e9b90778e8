// Declares which blocks of a depth frame lie on one face.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <span>

#include "palpate/depth/depth_filter.hpp"

namespace palpate {

/// Answers questions about the faces to which the blocks of a frame belong.
struct BlockFaces {
  static constexpr float kSame = 0.94f;      ///< least cosine within a face: 20 degrees (judgement)
  static constexpr float kCertainly = 3;     ///< deviations (judgement)
  static constexpr float kOfSupport = 0.1f;  ///< of R, that a face may be bent (judgement)

  const FilteredDepth& depth;
  std::span<const float> radii;  ///< R of the blocks, m; 0: no point

  [[nodiscard]] bool fitted(std::size_t block) const {
    return depth.states[block] == FilteredDepth::State::fitted && depth.confidences[block] > 0 &&
           radii[block] > 0;
  }

  /// The block (x, y) away from one; the image's size where there is none.
  [[nodiscard]] std::size_t beside(std::size_t block, int x, int y) const {
    const int u = static_cast<int>(block) % depth.columns + x;
    const int v = static_cast<int>(block) / depth.columns + y;
    const bool inside = u >= 0 && v >= 0 && u < depth.columns && v < depth.rows;
    return inside ? static_cast<std::size_t>(v * depth.columns + u) : depth.size();
  }

  /// How high `block` lies above the plane of another, m.
  [[nodiscard]] float height(std::size_t block, std::size_t above) const {
    return depth.normals[above].dot(depth.positions[block] - depth.positions[above]);
  }

  /// The largest distance of `block` from a face that it lies on, m.
  [[nodiscard]] float room(std::size_t block, std::size_t of) const {
    const float variance = depth.deviations[of] * depth.deviations[of] +
                           depth.deviations[block] * depth.deviations[block];
    return kOfSupport * radii[of] + kCertainly * std::sqrt(variance);
  }

  [[nodiscard]] bool shares_face(std::size_t block, std::size_t of) const {
    return block < depth.size() && fitted(block) &&
           depth.normals[block].dot(depth.normals[of]) >= kSame &&
           std::abs(height(block, of)) <= room(block, of);
  }
};

}  // namespace palpate
