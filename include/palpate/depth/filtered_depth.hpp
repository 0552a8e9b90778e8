#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "palpate/depth/noise_model.hpp"

namespace palpate {

/// What is known of one 2x2 block of pixels.
enum class BlockState : std::uint8_t {
  empty,   ///< nothing measured, or rejected (flying pixels)
  plain,   ///< mean of its pixels, normal from its neighbours: outside the region to be fitted
  fitted,  ///< place and normal from the noise-sized fit
};

/// A depth frame made into points, one a block of 2x2 pixels, row by row. A block's number is its
/// points' identity from frame to frame as long as the camera stands still. All columns have
/// columns * rows entries; those of empty blocks mean nothing.
struct FilteredDepth {
  double stamp = 0;                                                  ///< of the frame, s
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();  ///< at the stamp
  int columns = 0;                                                   ///< of blocks
  int rows = 0;
  double pitch = 0;  ///< angle between blocks: metres between blocks for one metre of depth
  std::vector<BlockState> states;
  std::vector<Eigen::Vector3f> positions;  ///< sensor frame, m
  std::vector<Eigen::Vector3f> normals;    ///< sensor frame, unit, towards the sensor; zero: none
  std::vector<float> confidences;          ///< c_i of the normals, 0-1
  std::vector<float> deviations;           ///< sd of the position along the ray, m
  std::vector<float> spacings;  ///< s_i: largest distance to a neighbouring block's point
                                ///< on the same surface, m (grazing rows are far apart)
  NoiseModel noise;             ///< in use for this frame
  bool duplicate = false;       ///< the frame repeats the one before, bit for bit

  [[nodiscard]] std::size_t size() const { return states.size(); }
};

}  // namespace palpate
