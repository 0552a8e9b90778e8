// Declares what is decided of a store before its points are sorted.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "io/tile/cell_counter.hpp"
#include "io/tile/frame.hpp"
#include "io/tile/input.hpp"

namespace palpate::io::tile {

using Inputs = std::vector<std::unique_ptr<TileInput>>;

/// Called with 0 ... 1 now and then, never twice at once; may throw to give up.
using Told = std::function<void(double)>;

/// Smallest and largest of a column.
struct Range {
  std::uint16_t low = 0xFFFF;
  std::uint16_t high = 0;

  void add(std::uint16_t value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const Range& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

struct Plan {
  Frame frame;
  Layout layout;
  std::size_t points = 0;
  std::size_t dropped = 0;  ///< marked as not to be used, or beyond 10^12 m
  Numbers lowest{};         ///< of all points
  Numbers highest{};
  Range intensity;
  std::array<Range, 3> color;
  std::vector<std::uint16_t> color_factors;  ///< of each input: 257 where it has colours of a byte
  std::vector<Chunk> chunks;                 ///< along the Morton curve
};

/// Reads all points once, and more often where their cloud has strays.
/// @param most points of a chunk. @throws Error where there is no point, or too many.
[[nodiscard]] Plan make_plan(const Inputs& inputs, std::size_t most, const Told& told);

/// What reading a piece of an input gave.
struct Piece {
  std::size_t input = 0;
  std::vector<StorePoint> points;  ///< those inside the cube
  std::size_t dropped = 0;
  std::size_t outside = 0;
  Box box;  ///< of all that are not dropped, in steps from the cube's corner
};

/// Reads all points of all inputs and calls take() with one piece after another.
void read_all(const Inputs& inputs, const Frame& frame, const Told& told,
              const std::function<void(const Piece&)>& take);

}  // namespace palpate::io::tile
