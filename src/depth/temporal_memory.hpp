#pragma once

#include <cstdint>

#include "palpate/depth/filtered_depth.hpp"

namespace palpate::depth {

/// What the filter over time remembers of one block; see BlockFits for the columns.
struct BlockMemory {
  float rho = 0;             ///< mean inverse depth, 1/m
  float variance = 0;        ///< of one frame's rho, 1/m^2: of the mean it is variance / count
  float extra = 0;           ///< variance that moving into other views has added, 1/m^2
  float slope_x = 0;         ///< 1/m
  float slope_y = 0;         ///< 1/m
  float slope_variance = 0;  ///< of one frame's slopes, 1/m^2
  float confidence = 0;
  float calm_since = 0;     ///< rho of the last frame that was not calm, 1/m
  float last[3] = {};       ///< rho, slope_x and slope_y of the last frame, 1/m
  float moves[3] = {};      ///< from the frame before to the last, 1/m
  float scatter = 0;        ///< variance of one frame's rho that the frames themselves show, 1/m^2
  float slope_scatter = 0;  ///< the same of its slopes
  std::uint8_t count = 0;   ///< frames in the mean; 0: nothing is remembered
  std::uint8_t calm = 0;    ///< frames in a row that a moving block stood still
  std::uint8_t missed = 0;
  bool moving = false;
  BlockState state = BlockState::empty;
};

/// A change of inverse depth beyond this is another surface, not one that moves: 30 mm, what a
/// hand's 1 m/s covers in a frame.
[[nodiscard]] inline float another_surface(float rho) {
  return 0.03F * rho * rho;
}

}  // namespace palpate::depth
