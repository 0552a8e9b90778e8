// Holds the plane of each point: the columns that steps of prepare() fill and refine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace palpate {

/// The plane of each point, of its own segment alone, in sorted order.
struct PointFits {
  std::vector<Eigen::Vector3f> normals;  ///< unit, sign arbitrary; zero: undefined
  std::vector<float> confidences;        ///< planarity, 0-1
  std::vector<float> residuals;          ///< rms distance from the plane, m
  std::vector<float> quadric_residuals;  ///< the same from a quadric, where the plane leaves much
  std::vector<std::uint8_t> others;      ///< 1: points of other segments are around
  std::vector<float> asides;  ///< distance to the mean of the points around, over their reach
};

}  // namespace palpate
