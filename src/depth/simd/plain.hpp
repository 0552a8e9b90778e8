#pragma once

#include <cstddef>
#include <cstdint>

#include "depth/simd/fits.hpp"

// What is done to every block of every frame: the code that is compiled once for each level of the
// instruction set. Plain pointers and numbers alone cross this border. All functions do one row;
// rows of blocks have at least kPlainLanes empty blocks before and behind them.

namespace palpate::simd {

constexpr int kPlainLanes = 8;

// Depths that are believed, and what those of one surface may differ by: width[0] + width[1] z +
// width[2] z^2.
struct DepthGate {
  float nearest, farthest;  // m
  float width[3];
};

// Deviation of a full block's inverse depth: sigma[2] + sigma[1] rho + sigma[0] rho^2. A
// neighbour shows the same surface within `close` deviations and `steep` rho, three blocks lie on
// a line within `straight` deviations.
struct BlockLimits {
  float sigma[3];
  float close, steep, straight;
};

struct PlainFunctions {
  // Means of 2x2 pixels, of those near their median: `pixels` is the upper row of them, `width`
  // apart from the lower one.
  void (*average)(const float* pixels, std::ptrdiff_t width, int columns, const DepthGate& gate,
                  float* rho, std::uint8_t* counts) noexcept;
  // `rho` is what the image was, with rows `stride` apart; blocks with fewer than `supporters`
  // neighbours that continue them are emptied in `to` and `counts`.
  void (*reject)(const float* rho, std::ptrdiff_t stride, int columns, const BlockLimits& limits,
                 int supporters, float* to, std::uint8_t* counts) noexcept;
  // Slopes by least squares over 3x3 blocks. `per_x`, `per_y`: blocks for one unit of the ray.
  void (*fit)(const float* rho, const std::uint8_t* counts, std::ptrdiff_t stride, int columns,
              const BlockLimits& limits, float per_x, float per_y, const FitRow& out) noexcept;
};

extern const PlainFunctions kPlainBaseline;
extern const PlainFunctions kPlainV3;  // x86-64-v3; the same numbers bit for bit

// The better that this processor has.
const PlainFunctions& best_plain() noexcept;

}  // namespace palpate::simd
