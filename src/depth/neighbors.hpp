#pragma once

#include "depth/blocks.hpp"
#include "depth/window_fits.hpp"

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

inline constexpr int kLongestGap = 3;  ///< blocks

/// Blocks of `range` without small holes: `filled` gets a copy in which gaps in rows, then in
/// columns, of up to kLongestGap blocks between two ends that may be one surface are bridged.
/// Filled blocks have a count of 0. One hole would otherwise cost all windows around it.
void fill_gaps(const Blocks& blocks, const NoiseModel& noise, const BlockRange& range,
               Blocks& filled);

}  // namespace palpate::depth
