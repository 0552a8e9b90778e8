// Declares what is decided of a store before its points are sorted, and their first sorting.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "extras/tile/frame.hpp"
#include "extras/tile/input.hpp"

namespace palpate::io::tile {

/// Called with 0 ... 1 now and then, never twice at once; may throw to give up.
using Report = std::function<void(double)>;

/// Smallest and largest of a column.
struct Range {
  std::uint16_t low = 0xFFFF;
  std::uint16_t high = 0;

  void add(std::uint16_t value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

struct Plan {
  Frame frame;
  Layout layout;
  std::size_t points = 0;
  std::size_t dropped = 0;  ///< marked as not to be used, or beyond 10^12 m
  Numbers highest{};        ///< of all points; the lowest are 0
  Range intensity;
  std::array<Range, 3> color;
  std::vector<std::uint16_t> color_factors;  ///< of each input: 257 where it has colours of a byte
  std::vector<Cell> chunks;  ///< cubes that are sorted by themselves, along the Morton curve
};

/// Reads all points; again where the step was too fine for where they are.
/// @param most points of a chunk; more have the same position. Of many points a sample shows where
///   they are, so it is a little more at times.
/// @throws Error where there is no point, or too many.
[[nodiscard]] Plan make_plan(const std::vector<TileInput>& inputs, std::size_t most,
                             const Report& report);

/// Reads all points again and appends each to the file of its chunk, which has the chunk's number
/// for a name. A chunk without points has no file.
void distribute(const std::vector<TileInput>& inputs, const Plan& plan,
                const std::filesystem::path& folder, const Report& report);

}  // namespace palpate::io::tile
