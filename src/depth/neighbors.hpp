#pragma once

#include "depth/block_fits.hpp"
#include "depth/blocks.hpp"

namespace palpate::depth {

/// How far a neighbouring block's inverse depth may differ on the same surface.
struct SameSurface {
  static constexpr float kClose = 4.3F;  ///< 3 sigma of the difference of two blocks

  NoiseModel noise;
  float steep = 0;  ///< relative change of depth from block to block

  SameSurface(const NoiseModel& noise_model, const BlockGrid& grid);
  /// `distance` in blocks.
  [[nodiscard]] float limit(float rho, float distance = 1) const {
    return kClose * block_sigma(noise, rho) + steep * distance * rho;
  }
};

/// Empties blocks that stand between surfaces: those that fewer than two of their eight neighbours
/// continue, be it by lying close or by lying on a line with the block and its opposite neighbour.
/// `scratch` is kept for its memory.
void reject_flying(const NoiseModel& noise, Blocks& blocks, std::vector<float>& scratch);

/// Plain fits: each block's own mean, its slopes by least squares over those of its eight
/// neighbours that show the same surface.
void fit_plain(const Blocks& blocks, const NoiseModel& noise, BlockFits& fits);

}  // namespace palpate::depth
