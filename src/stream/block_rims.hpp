// Declares the weights of the points of a depth frame that lie beside rims and holes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/geometry/shapes.hpp"
#include "stream/hidden_planes.hpp"
#include "stream/lanes.hpp"
#include "stream/padded_blocks.hpp"

namespace palpate {

/// Weighs points that lie beside rims and holes by what is around them.
class BlockRims {
 public:
  static constexpr int kLargestWindow = 8;  ///< blocks on either side (judgement)

  enum class Exact { nowhere, within, everywhere };

  /// `minimum_radius`: no R below this, m.
  BlockRims(Kernel kernel, float minimum_radius)
      : kernel_(kernel), minimum_radius_(minimum_radius) {}

  /// Finds the blocks beside rims, inside the balls (sensor frame) or everywhere, of those that are
  /// not kept, or of the `whole` image; where a surface goes on `hidden` there is no rim. `radii`:
  /// of all blocks, and room for kLanes more; `padded`: where they are.
  void find(const FilteredDepth& depth, std::span<const float> radii, const PaddedBlocks& padded,
            const HiddenPlanes& hidden, std::span<const Ball> balls, Exact exact, bool whole);

  /// The largest distance to a neighbour that counts, blocks; 0: there is no rim.
  [[nodiscard]] int largest_half() const { return largest_half_; }

  /// Sets the areas of those that were found. `padded` has margins as large.
  void weigh(const FilteredDepth& depth, std::span<const float> radii, PaddedBlocks& padded,
             std::span<float> areas) const;

 private:
  void mark(const FilteredDepth& depth, std::span<const float> radii, const PaddedBlocks& padded);
  [[nodiscard]] int half_window(const FilteredDepth& depth, std::size_t block, float radius) const;
  [[nodiscard]] bool near_rim(const FilteredDepth& depth, std::size_t block, int half) const;
  template <class Take>
  void sum_around(const FilteredDepth& depth, const PaddedBlocks& padded, const float* factors,
                  const Take& take) const;

  Kernel kernel_;
  float minimum_radius_;
  std::vector<std::int32_t> rims_;  // blocks without or beside another surface, summed up to each
  std::vector<std::int32_t>
      halves_;                   // of windows whose sums are taken from neighbours; 0: none are
  std::vector<int> row_halves_;  // the largest of each row
  int largest_half_ = 0;
};

}  // namespace palpate
