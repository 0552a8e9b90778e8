#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// Spacings within which neighbours say something about each other's normals.
inline constexpr float kVoteReach = 1.6f;

/// How far two points' normals agree on what is outside, -1 ... 1: n_p, mirrored by the plane
/// halfway between the points, times n_q. 0 says nothing.
[[nodiscard]] inline float agreement(const Eigen::Vector3f& p, const Eigen::Vector3f& n_p,
                                     const Eigen::Vector3f& q, const Eigen::Vector3f& n_q) {
  const Eigen::Vector3f d = q - p;
  const float squared = d.squaredNorm();
  const float straight = n_p.dot(n_q);
  return squared > 0 ? straight - 2 * n_p.dot(d) * n_q.dot(d) / squared : straight;
}

/// Spacings and normals are those of the sorted points.
struct PatchInput {
  const CellGrid& grid;
  std::span<const float> spacings;  // m
  std::span<const Eigen::Vector3f> normals;

  [[nodiscard]] float agreement_of(std::uint32_t i, std::uint32_t j) const {
    return agreement(grid.points()[i], normals[i], grid.points()[j], normals[j]);
  }
};

/// Points whose normals surely belong together.
struct Patches {
  std::vector<std::uint32_t> patch;  ///< of each point
  std::vector<float> sign;           ///< of each point's normal in its patch, +1 or -1
  std::uint32_t count = 0;
};

[[nodiscard]] Patches make_patches(const PatchInput& input);

}  // namespace palpate::detail
