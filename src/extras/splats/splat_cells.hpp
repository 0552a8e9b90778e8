// Adds up the splats of a scene in the cells of a grid.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "extras/splats/splat_shell.hpp"

namespace palpate::detail {

/// A grid of cubes, numbered from 0 to kMost along each axis. Neighbours of a cell's key differ
/// from it by a number that is the same for every cell, and keys sort by x, then y, then z.
struct SplatGrid {
  static constexpr int kBits = 15;  // an axis: two and their signs are a record's key (derived)
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

  [[nodiscard]] static std::array<std::int64_t, 3> indices_of(std::uint64_t key) {
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
  float depth = 0;   ///< optical depth: light that passes is exp(-depth)
  float behind = 0;  ///< share of the light that comes from behind the normal
  float height = 0;  ///< above the position, of where half of the light is gone, m; NaN: nowhere
  bool confident = false;  ///< do its splats agree on the normal?
};

/// A splat in a cell, by its strongest sample there.
struct SplatShare {
  std::uint64_t key = 0;
  std::uint32_t splat = 0;
  std::uint32_t sample = 0;

  [[nodiscard]] bool operator<(const SplatShare& other) const {
    return key != other.key ? key < other.key : splat < other.splat;
  }
};

/// Opacity below which renderers pass over a splat.
inline constexpr float kFaintest = 1.F / 255;
inline constexpr float kMostOpaque = 0.99F;  ///< renderers clamp opacities to it

/// Axes of a splat, the shortest first.
[[nodiscard]] std::array<int, 3> sorted_axes(const Splat& splat);

/// Samples that a splat takes in cells of this edge, m. Infinite where it cannot be computed.
[[nodiscard]] double samples_of(const Splat& splat, float edge);

/// Every splat's shares, sorted by cell.
[[nodiscard]] std::vector<SplatShare> shares_of(std::span<const Splat> splats,
                                                const SplatGrid& grid);

/// The cells that the shares are in, sorted by key.
[[nodiscard]] std::vector<SplatCell> cells_of(std::span<const SplatShare> shares,
                                              std::span<const Splat> splats, const SplatGrid& grid);

}  // namespace palpate::detail
