#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "depth/blocks.hpp"
#include "palpate/geometry/ball.hpp"

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

}  // namespace palpate::depth
