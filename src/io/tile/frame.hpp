// Declares what the parts of a store share: whole numbers for coordinates, cubes of the octree, and
// points as bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/little_endian.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io::tile {

/// The most bits of a number: they leave an int32's sign alone, and a cube a level more.
inline constexpr int kMostBits = 30;

/// Coordinates as whole numbers of steps from the lower corner of the root's cube.
using Numbers = std::array<std::uint32_t, 3>;

struct Frame {
  double step = 0;                                  ///< m
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< m, corner of the root's cube
  int bits = 0;                                     ///< its edge has 2^bits steps

  [[nodiscard]] double edge() const { return std::ldexp(step, bits); }  ///< m
};

/// A cube of the octree: level 0 is the root, whose edge each level halves.
struct Cell {
  int level = 0;
  Numbers at{};  ///< along x, y and z, 0 ... 2^level - 1

  auto operator<=>(const Cell&) const = default;  // NOLINT(modernize-use-nullptr): its 0

  /// Child 0 - 7: bit 2 is the upper half in x, 1 in y, 0 in z, as in Potree's files.
  [[nodiscard]] Cell child(unsigned index) const {
    return {
        level + 1,
        {2 * at[0] + (index >> 2U & 1U), 2 * at[1] + (index >> 1U & 1U), 2 * at[2] + (index & 1U)}};
  }
};

/// The cube of a level around a place.
[[nodiscard]] inline Cell cell_of(const Numbers& numbers, int level, int bits) {
  const int shift = bits - level;
  return {level, {numbers[0] >> shift, numbers[1] >> shift, numbers[2] >> shift}};
}

/// Spreads the lower 21 bits of three numbers so that those of x come first, then y and z.
[[nodiscard]] inline std::uint64_t morton(const Numbers& numbers) {
  const auto spread = [](std::uint64_t v) {
    v &= 0x1FFFFF;
    v = (v | v << 32) & 0x1F00000000FFFF;
    v = (v | v << 16) & 0x1F0000FF0000FF;
    v = (v | v << 8) & 0x100F00F00F00F00F;
    v = (v | v << 4) & 0x10C30C30C30C30C3;
    return (v | v << 2) & 0x1249249249249249;
  };
  return spread(numbers[0]) << 2 | spread(numbers[1]) << 1 | spread(numbers[2]);
}

/// A point of a store.
struct StorePoint {
  Numbers numbers;
  std::uint16_t intensity;
  std::array<std::uint16_t, 3> color;
};

/// How a point lies in bytes: three int32, then what the store has of intensity and colour.
struct Layout {
  bool intensities = false;
  bool colors = false;

  [[nodiscard]] std::size_t size() const {
    return 12 + (intensities ? 2U : 0U) + (colors ? 6U : 0U);
  }

  void put(const StorePoint& point, std::span<std::byte> record) const {
    LittleEndianWriter out(record);
    for (const std::uint32_t n : point.numbers) out.put(n);
    if (intensities) out.put(point.intensity);
    if (!colors) return;
    for (const std::uint16_t c : point.color) out.put(c);
  }
};

/// The numbers of a point from its bytes.
[[nodiscard]] inline Numbers numbers_of(const std::byte* record) {
  return {load_as<std::uint32_t>(record), load_as<std::uint32_t>(record + 4),
          load_as<std::uint32_t>(record + 8)};
}

}  // namespace palpate::io::tile
