// Adds up the splats of a scene in the cells of a grid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/splat_shell.hpp"

namespace palpate::detail {

/// A grid of cubes, numbered from 0 to kMost along each axis. Neighbours of a cell's key differ
/// from it by a number that is the same for every cell, and keys sort by x, then y, then z.
struct SplatGrid {
  static constexpr int kBits = 20;                         // an axis; two keys make a line's name
  static constexpr std::int64_t kHalf = 1 << (kBits - 1);  // cells from the middle to an end

  Eigen::Vector3f middle = Eigen::Vector3f::Zero();  ///< m
  float edge = 0;                                    ///< of a cell, m

  /// The key of the cell that holds `p`; none outside of the grid and in its outermost cells.
  [[nodiscard]] std::optional<std::uint64_t> key_of(const Eigen::Vector3f& p) const {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float cell = std::floor((p[axis] - middle[axis]) / edge);
      if (!(std::abs(cell) < static_cast<float>(kHalf - 1))) return std::nullopt;
      key = key << kBits | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell) + kHalf);
    }
    return key;
  }

  [[nodiscard]] static std::array<std::int64_t, 3> place_of(std::uint64_t key) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;  // of an axis (derived)
    return {static_cast<std::int64_t>(key >> (2 * kBits)),
            static_cast<std::int64_t>(key >> kBits & kMask),
            static_cast<std::int64_t>(key & kMask)};
  }

  /// What a step of (x, y, z) cells adds to a key.
  [[nodiscard]] static std::uint64_t step(int x, int y, int z) {
    const std::int64_t sum = (std::int64_t{x} << (2 * kBits)) + (std::int64_t{y} << kBits) + z;
    return static_cast<std::uint64_t>(sum);
  }
};

/// A cell that splats show in.
struct SplatCell {
  std::uint64_t key = 0;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< m; mean by optical depth
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, of any sign; zero: none
  Eigen::Vector3f color = Eigen::Vector3f::Zero();     ///< red, green, blue, 0 to 255
  float depth = 0;    ///< optical depth: light that passes is exp(-depth)
  bool sure = false;  ///< do its splats agree on the normal?
};

/// The grid whose cells suit the splats. Its edge is 0 where no splat is opaque or has an extent.
[[nodiscard]] SplatGrid grid_for(std::span<const Splat> splats);

/// The cells that splats show in, sorted by key. Makes the grid coarser where they would fill
/// memory.
[[nodiscard]] std::vector<SplatCell> cells_of(std::span<const Splat> splats, SplatGrid& grid);

}  // namespace palpate::detail
