#pragma once

#include <span>
#include <vector>

#include "depth/block_fits.hpp"
#include "depth/blocks.hpp"
#include "depth/face_fits.hpp"
#include "depth/fit_region.hpp"
#include "depth/simd/fits.hpp"

namespace palpate::depth {

/// The noise-sized fit of nss_fast.md section 1: round each block the largest window in which the
/// noise explains what a plane or a paraboloid leaves, beside the block where an edge is near.
/// Several threads share the rows; results do not depend on how.
class WindowFits {
 public:
  explicit WindowFits(const simd::FitFunctions& functions = simd::best_fits())
      : functions_(&functions) {}

  /// Replaces the plain fits of the region's blocks where a window fits.
  void fit(const Blocks& blocks, const NoiseModel& noise, double normal_error,
           const FitRegion& region, BlockFits& fits);

 private:
  struct alignas(64) Place {
    double sums[simd::kWindowSums];
  };

  [[nodiscard]] simd::FitInput input(const Blocks& blocks, const NoiseModel& noise,
                                     double normal_error, const BlockRange& range);
  void list_columns(const Blocks& blocks, const FitRegion& region);
  void fit_row(const simd::FitInput& in, int row, std::span<const std::int32_t> columns,
               BlockFits& fits) const;

  const simd::FitFunctions* functions_;
  Blocks filled_;
  std::vector<Place> table_;
  std::vector<std::int32_t> columns_;  // of the region's blocks, row after row
  std::vector<std::size_t> row_begin_;
  FaceFits faces_;
};

}  // namespace palpate::depth
