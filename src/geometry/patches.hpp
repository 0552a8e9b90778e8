#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/signed_forest.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// Points whose normals surely belong together, and what neighbours say about the rest.
struct Patches {
  std::vector<std::uint32_t> patch;  ///< of each point
  std::vector<float> sign;           ///< of each point's normal in its patch, +1 or -1
  std::uint32_t count = 0;
  std::vector<Vote> votes;  ///< between patches
};

/// How far two points' normals agree on what is outside, -1 ... 1: n_i, mirrored by the plane
/// halfway between the points, times n_j. 0 says nothing.
[[nodiscard]] float agreement(const Eigen::Vector3f& p, const Eigen::Vector3f& n_p,
                              const Eigen::Vector3f& q, const Eigen::Vector3f& n_q);

/// spacings, normals: of the sorted points.
[[nodiscard]] Patches make_patches(const CellGrid& grid, std::span<const float> spacings,
                                   std::span<const Eigen::Vector3f> normals);

}  // namespace palpate::detail
