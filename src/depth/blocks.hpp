#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "depth/block_grid.hpp"
#include "depth/simd/fits.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// The measured means of 2x2 blocks, in rows with a margin of empty blocks all around so that
/// neighbours may be looked at without asking where the image ends.
struct Blocks {
  static constexpr int kMargin = 8;  ///< of blocks on each side

  BlockGrid grid;
  std::size_t stride = 0;            ///< from row to row
  std::vector<float> rho;            ///< 1 / mean depth, 1/m; 0: empty
  std::vector<std::uint8_t> counts;  ///< pixels in the mean, 0-4

  void resize(const BlockGrid& new_grid);
  /// Place of a block in the columns; from -kMargin to columns + kMargin - 1, rows alike.
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row + kMargin) * stride +
           static_cast<std::size_t>(column + kMargin);
  }
};

/// Averages what lies within three sigma of a block's median depth (and what a steep surface may
/// differ by within a block). A block whose pixels are all farther from their median, because it
/// looks half at one surface and half at another, is empty. `image` has rows of `width` pixels.
void average_blocks(const float* image, int width, const NoiseModel& noise,
                    const DepthFilterOptions& range, Blocks& blocks);

/// Deviation of the mean of a full block in those of a pixel: half of it where its four pixels err
/// alone, all of it where they err together.
[[nodiscard]] inline double block_share(double correlation) {
  return std::min(0.5 * correlation, 1.0);
}

/// By how much the variance of a mean of many blocks is larger than if they erred alone.
[[nodiscard]] inline double shared_error(double correlation) {
  return std::max(0.25 * correlation * correlation, 1.0);
}

/// The same of a term of degree 0 (the mean itself), 1 or 2 over so many blocks.
[[nodiscard]] inline double shared_error(double correlation, int degree, double blocks) {
  const double shared = shared_error(correlation);
  return shared / (1 + simd::kUnseenShare[degree] * (shared - 1) / blocks);
}

/// Deviation of the mean of a full block, 1/m, at inverse depth rho.
[[nodiscard]] inline float block_sigma(const NoiseModel& noise, float rho) {
  const auto& s = noise.coefficients;
  const double pixel = s[2] + rho * (s[1] + rho * s[0]);  // sigma(z) / z^2
  return static_cast<float>(block_share(noise.correlation) * (pixel > 0 ? pixel : 0));
}

}  // namespace palpate::depth
