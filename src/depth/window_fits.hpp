#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "depth/blocks.hpp"
#include "depth/face_fits.hpp"
#include "depth/simd/fits.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::depth {

/// A rectangle of blocks.
struct BlockRange {
  int first_column = 0;
  int first_row = 0;
  int columns = 0;
  int rows = 0;

  bool operator==(const BlockRange&) const = default;
  [[nodiscard]] bool empty() const { return columns <= 0 || rows <= 0; }
  /// Larger by `border` on all sides, as far as the grid goes.
  [[nodiscard]] BlockRange grown(int border, const BlockGrid& grid) const;
};

/// Which blocks are to be fitted: all, or those whose points lie in one of a few balls.
class FitRegion {
 public:
  /// Everything.
  void set(const BlockGrid& grid);
  /// What lies in the balls (world frame).
  void set(const BlockGrid& grid, const Eigen::Isometry3d& T_world_sensor,
           std::span<const Ball> balls);

  [[nodiscard]] bool operator==(const FitRegion& other) const;

  /// Blocks outside of it are outside of the region.
  [[nodiscard]] const BlockRange& range() const { return range_; }
  /// Appends the columns of a row's blocks that are in the region and not empty.
  void columns(const Blocks& blocks, int row, std::vector<std::int32_t>& columns) const;

 private:
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;

  bool everything_ = false;
  BlockRange range_;
  std::vector<Ball> balls_;  // sensor frame
};

/// The noise-sized fit of docs/method.md 6.3: round each block the largest window in which the
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
