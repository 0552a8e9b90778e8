#pragma once

#include <cstddef>
#include <cstdint>

// The noise-sized fit of docs/method.md 6.3: the code that is compiled once for each level of
// the instruction set. Plain pointers and numbers alone cross this border.

namespace palpate::simd {

// What a block's window is: bent; a plane as large as windows become; a plane in a smaller window
// alone, since the largest one is refused.
enum Flatness : std::uint8_t { kBentWindow, kStraight, kPlaneNearBy };

// A row of the columns of BlockFits.
struct FitRow {
  std::uint8_t* states;
  float* rho;
  float* variance;
  float* slope_x;
  float* slope_y;
  float* slope_variance;
  float* confidences;
  std::uint8_t* flat;
  std::uint8_t* reach_u;
  std::uint8_t* reach_v;
};

constexpr int kWindowSums = 8;         // doubles at each entry of a table
constexpr int kLargestWindow = 40;     // blocks from a window's middle to its border, at most
constexpr double kBlock = 1 << 20;     // what each block that is no hole adds to the last sum
constexpr double kRhoUnits = 1 << 20;  // inverse depths are counted in 2^-20 / m

// Sizes of windows that are tried, and their shares of the largest (docs/method.md 6.3).
constexpr int kSizes = 6;
// 4^((k - 5) / 5), k = 0 ... 5: from a quarter on (docs/method.md 6.3)
constexpr float kRatios[kSizes] = {.25F, .329877F, .435275F, .574349F, .757858F, 1};

// Errors shared by a large part of a window hardly change slopes and bends in it: over n blocks the
// variance of a term of degree 0, 1, 2 is shared / (1 + this (shared - 1) / n) times what it would
// be if blocks erred alone (docs/method.md 6.2). For Gaussian correlation over up to a fifth of the
// window's side that is within a third.
constexpr double kUnseenShare[] = {1.6, 5, 10};

// Blocks in rows with a margin: pointers are to the block (0, 0).
struct BlockRows {
  const float* rho;            // inverse depth, 1/m; 0: hole
  const std::uint8_t* counts;  // pixels measured; 0: filled, if rho is not 0
  std::ptrdiff_t stride;       // from row to row
};

// Running sums over the blocks [first_column, first_column + columns) x [first_row, ...): entry
// (c, r) has the sums over the c x r blocks left and above of it, so there are columns + 1 by
// rows + 1 entries. u and v count from the table's middle.
struct WindowTable {
  double* sums;
  int first_column, first_row;
  int columns, rows;
};

// Inputs of fits beside the table.
struct FitInput {
  WindowTable table;
  BlockRows blocks;       // measured only, nothing filled
  double x0, y0;          // ray of block (0, 0)
  double step_x, step_y;  // from block to block
  double noise[3];        // sigma(rho) = noise[2] + noise[1] rho + noise[0] rho^2 of a full block
  double shared;          // by how much means of many vary more than if their blocks erred alone
  double pixel_noise[3];  // of one pixel, without correlation, alike
  double close, steep;    // BlockLimits'
  double normal_error;    // theta, rad
  double growth;          // min(2, sqrt c): how much larger windows are for correlated noise
};

struct FitFunctions {
  // Writes all entries of the table.
  void (*table)(const WindowTable& table, const BlockRows& filled) noexcept;
  // Fits `count` blocks of one row, rising columns. `out` holds plain fits on entry; states stay.
  void (*fit)(const FitInput& input, int row, const std::int32_t* columns, int count,
              const FitRow& out) noexcept;
};

extern const FitFunctions kFitsBaseline;
extern const FitFunctions kFitsV3;  // x86-64-v3; the same numbers bit for bit

// The better that this processor has.
const FitFunctions& best_fits() noexcept;

// Functions that run on every block of every frame, compiled once for each level of the instruction
// set. They take plain pointers and numbers only. Each does one row; rows of blocks have at least
// kPlainLanes empty blocks before and behind them.

constexpr int kPlainLanes = 8;  // floats in 256 bits

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
