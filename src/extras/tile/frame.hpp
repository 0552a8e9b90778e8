// Declares what the files of a store share: whole numbers for coordinates, cubes of the octree, and
// points as bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/little_endian.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io::tile {

/// The most bits of a number: they leave an int32's sign alone, and a cube a level more.
inline constexpr int kMostBits = 30;

/// Coordinates as whole numbers of steps from the lower corner of the root's cube.
using Numbers = std::array<std::uint32_t, 3>;

/// Does a position come first along the Morton curve, whose bits are those of x, y and z in turn?
/// The axis decides in which the highest bit differs.
[[nodiscard]] inline bool before(const Numbers& a, const Numbers& b) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    const std::uint32_t most = a[axis] ^ b[axis];
    const std::uint32_t differ = a[k] ^ b[k];
    if (most < differ && most < (most ^ differ)) axis = k;
  }
  return a[axis] < b[axis];
}

struct Frame {
  double step = 0;                                   ///< m
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d low = Eigen::Vector3d::Zero();     ///< steps from there to the root's cube
  int bits = 0;                                      ///< its edge has 2^bits steps

  [[nodiscard]] double edge() const { return std::ldexp(step, bits); }  ///< m
  [[nodiscard]] Eigen::Vector3d position(const Numbers& n) const {      ///< m
    return origin + step * (low + Eigen::Vector3d(n[0], n[1], n[2]));
  }
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

/// The cube of a level around a position, which is counted in so many bits.
[[nodiscard]] inline Cell cell_of(const Numbers& numbers, int level, int bits) {
  const int shift = bits - level;
  return {level, {numbers[0] >> shift, numbers[1] >> shift, numbers[2] >> shift}};
}

/// Which child of a cube of a level contains a position in it. Rises along the Morton curve.
[[nodiscard]] inline unsigned child_at(const Numbers& numbers, int level, int bits) {
  const int shift = bits - level - 1;
  return (numbers[0] >> shift & 1U) << 2U | (numbers[1] >> shift & 1U) << 1U |
         (numbers[2] >> shift & 1U);
}

/// A point of a store.
struct StorePoint {
  Numbers numbers;
  std::uint16_t intensity;
  std::array<std::uint16_t, 3> color;
};

/// How a point lies in bytes: three int32, then what the store has of intensity and colour.
struct Layout {
  bool intensities = true;
  bool colors = true;

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
