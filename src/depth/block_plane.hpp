#pragma once

namespace palpate::detail {

/// The piece of plane that one block of 2x2 pixels shows, in inverse depth rho = 1/z, where planes
/// are linear: du columns and dv rows of blocks from the block's centre it is
/// rho + slope_u du + slope_v dv.
struct BlockPlane {
  float rho = 0;       ///< 1/m; 0: nothing is known of the block
  float slope_u = 0;   ///< 1/m per block
  float slope_v = 0;   ///< 1/m per block
  float rho_sd = 0;    ///< standard deviation of rho, 1/m
  float slope_sd = 0;  ///< of the slopes, 1/m per block

  [[nodiscard]] bool known() const { return rho > 0; }
};

}  // namespace palpate::detail
