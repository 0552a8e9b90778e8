#pragma once

#include <span>
#include <vector>

#include "depth/blocks.hpp"
#include "depth/clipped_fit.hpp"

namespace palpate::depth {

/// Fits faces beside edges and creases again, each from its own blocks alone, and tells which face
/// a block lies on.
///
/// Windows reach over an edge by as much as noise hides, and their planes lean by that; or they
/// show what is hidden at their block. Where the planes of two faces meet is known better than what
/// one window spans. So one block of each tile looks eight ways for where its face ends, at a plane
/// that meets its own or at anything else, and fits all that is inside, up to twice a window's
/// reach away: what is straight needs no smaller windows. Blocks of its tile and of those around
/// take the nearest plane whose face holds them. What one bent surface explains better than two
/// planes is no edge. Up to some sixteen blocks from the rim of what is fitted, such planes may be
/// missing. Threads share the rows; results do not depend on how.
class FaceFits {
 public:
  /// `input`: what the fits were made from; `filled`: the blocks that its table sums.
  void refit(const simd::FitInput& input, const Blocks& filled, const NoiseModel& noise,
             BlockFits& fits);

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
            const BlockFits& fits, int tile_row);
  void share(const simd::FitInput& input, const NoiseModel& noise, int tile_row,
             BlockFits& fits) const;
  static void give(std::span<const Face* const> faces, float rho, float sigma, int column, int row,
                   BlockFits& fits);

  int tiles_ = 0;  // in a row
  int tile_rows_ = 0;
  std::vector<Face> faces_;
};

}  // namespace palpate::depth
