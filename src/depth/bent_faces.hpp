#pragma once

#include <cstdint>
#include <vector>

#include "depth/face_tiles.hpp"
#include "depth/quadric.hpp"

namespace palpate::depth {

/// Fits quadrics to what is bent, over all of it that is seen up to some 25 blocks away, and gives
/// its blocks the one that explains most.
///
/// Windows of single blocks are a few blocks large where a ball or a bottle turns away from the
/// camera, and noise leaves little of their slopes. What the whole thing shows is several times
/// as precise. One block in each 8 x 8 looks for a quadric. Only fitted blocks count, so up to
/// 50 blocks from the rim of the fitted region fits are less precise. Threads share the tiles;
/// results do not depend on how.
class BentFaces {
 public:
  /// `input`: what the fits were made from. Quadrics and fits of kept tiles stay.
  void refit(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
             BlockFits& fits);

 private:
  void find(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
            const BlockFits& fits, int tile_row);
  void share(const simd::FitInput& input, const NoiseModel& noise, const KeptTiles& kept,
             int tile_row, BlockFits& fits) const;

  static constexpr int kTile = 8;  // blocks to a side (judgement)
  static_assert(kTile % KeptTiles::kSide == 0);
  // Tiles within whose reach a block may lie (derived).
  static constexpr int kAround = kLargestReach / kTile + 1;

  FaceTiles tiles_{kTile, kAround};
  std::vector<std::uint8_t> found_;  // of each tile: has it a quadric?
  std::vector<Quadric> faces_;
};

}  // namespace palpate::depth
