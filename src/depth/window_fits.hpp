#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/bent_faces.hpp"
#include "depth/blocks.hpp"
#include "depth/face_tiles.hpp"
#include "depth/simd/fits.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::depth {

/// A half of the image as seen from a block: the blocks (u, v) away with at + x u + y v >= 0.
struct HalfImage {
  double at, x, y;

  [[nodiscard]] double above(int u, int v) const { return at + x * u + y * v; }
  /// Change of that across a block.
  [[nodiscard]] double block() const { return std::abs(x) + std::abs(y); }
};

/// A plane as seen from a block: (u, v) blocks away its inverse depth is rho + x u + y v, 1/m.
struct FacePlane {
  int column, row;  ///< of the block
  double rho, x, y;
  double variance, slope_variance;  ///< 1/m^2
  double lean_x = 0, lean_y = 0;    ///< covariances of rho with x and y, 1/m^2
  int reach_u = 0, reach_v = 0;     ///< blocks to each side that it was fitted to
  bool straight = false;            ///< bent by no more than noise does on average

  [[nodiscard]] double at(int u, int v) const { return rho + x * u + y * v; }
  [[nodiscard]] double variance_at(int u, int v) const {
    const double lean = 2 * (lean_x * u + lean_y * v);
    return std::max(variance, variance + lean + slope_variance * (u * u + v * v));
  }
};

/// `near` made better: the plane through all blocks up to `reach_u` columns and `reach_v` rows away
/// that lie in all halves, by least squares. None where they are few, have a hole, or noise does
/// not explain what the plane leaves of them.
[[nodiscard]] std::optional<FacePlane> clipped_fit(const simd::FitInput& input,
                                                   const NoiseModel& noise, const FacePlane& near,
                                                   int reach_u, int reach_v,
                                                   std::span<const HalfImage> halves);

/// Residual of the paraboloid through all blocks up to `reach` around the middle of `near`: a sum
/// of squares, 1/m^2. nullopt if one is a hole.
[[nodiscard]] std::optional<double> left_by_paraboloid(const simd::FitInput& input,
                                                       const FacePlane& near, int reach);

/// Fits faces beside edges and creases again, each from its own blocks alone, and finds the face
/// that a block lies on.
///
/// Windows reach over an edge by as much as noise hides, and their planes lean by that; or they
/// show what is hidden at their block. The line where the planes of two faces meet is more precise.
/// So one block of each tile looks in eight directions for the end of its face, at a plane that
/// meets its own or at anything else, and fits all blocks inside, up to twice a window's reach
/// away. Blocks of its tile and of those around take the nearest plane whose face holds them. Where
/// one bent surface explains the blocks better than two planes, there is no edge. Up to some
/// sixteen blocks from the rim of the fitted region, such planes may be missing. Threads share the
/// rows; results do not depend on how.
class FaceFits {
 public:
  /// `input`: what the fits were made from; `filled`: the blocks that its table sums. Faces and
  /// fits of kept tiles stay.
  void refit(const simd::FitInput& input, const Blocks& filled, const NoiseModel& noise,
             const KeptTiles& kept, BlockFits& fits);

 private:
  struct Face {
    bool found;
    FacePlane plane;
    int count;  // of borders
    HalfImage borders[8];

    [[nodiscard]] std::span<const HalfImage> sides() const {
      return {borders, static_cast<std::size_t>(count)};
    }
  };
  struct Search;

  void find(const simd::FitInput& input, const Blocks& filled, const NoiseModel& noise,
            const KeptTiles& kept, const BlockFits& fits, int tile_row);
  void share(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
             int tile_row, BlockFits& fits) const;
  static void give(std::span<const Face* const> faces, float rho, float sigma, int column, int row,
                   BlockFits& fits);

  static constexpr int kTile = 4;    // blocks to a side (docs/method.md 6.4)
  static constexpr int kAround = 2;  // tiles that share faces: ten blocks (docs/method.md 6.4)
  static_assert(KeptTiles::kSide % kTile == 0);

  FaceTiles tiles_{kTile, kAround};
  std::vector<Face> faces_;
};

/// Selects the blocks to fit: all, or those whose points lie in one of a few balls.
class FitRegion {
 public:
  /// Everything.
  void set(const BlockGrid& grid);
  /// Selects the blocks in the balls (world frame).
  void set(const BlockGrid& grid, const Eigen::Isometry3d& T_world_sensor,
           std::span<const Ball> balls);

  [[nodiscard]] bool operator==(const FitRegion& other) const;

  /// Nothing if both regions are the same; else a range outside of which blocks are in neither.
  [[nodiscard]] BlockRange change_from(const FitRegion& other) const;

  /// Blocks outside of it are outside of the region.
  [[nodiscard]] const BlockRange& range() const { return range_; }
  /// Writes the columns of a row's blocks that are in the region, not empty and not kept.
  /// @return how many
  int columns(const Blocks& blocks, const KeptTiles& kept, int row, std::int32_t* columns) const;

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

  /// Fits all blocks of the rows that windows of the region reach, but those that are kept: the
  /// region's where a window fits, the others plainly.
  /// @return a range with these rows; other rows of `fits` are as they were.
  [[nodiscard]] BlockRange fit(const Blocks& blocks, const NoiseModel& noise, double normal_error,
                               const FitRegion& region, const KeptTiles& kept, BlockFits& fits);

 private:
  struct alignas(64) Entry {
    double sums[simd::kWindowSums];
  };

  [[nodiscard]] simd::FitInput input(const Blocks& blocks, const NoiseModel& noise,
                                     double normal_error, const BlockRange& range);
  const simd::FitFunctions* functions_;
  Blocks filled_;
  std::vector<Entry> table_;
  std::vector<std::int32_t> columns_;  // of the region's blocks, with room for all of each row
  BentFaces bent_;
  FaceFits faces_;
};

}  // namespace palpate::depth
