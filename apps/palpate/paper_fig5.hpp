#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::app {

/// The three steps of preparation that the paper timed, ms.
struct PrepareTimes {
  double index = 0;  ///< the paper's kd-tree
  double normals = 0;
  double spacing = 0;

  [[nodiscard]] double sum() const { return index + normals + spacing; }
};

/// One size of cloud.
struct Fig5Row {
  std::size_t points = 0;       ///< that the paper had
  std::size_t points_here = 0;  ///< as near as a voxel filter comes to it
  double voxel = 0;             ///< its leaf, m
  PrepareTimes paper;           ///< on a Core i7-950
  PrepareTimes here;            ///< wall time on all cores, median
  double weights = 0;           ///< what we do besides: radii and density weights, ms
};

struct Fig5 {
  std::vector<Fig5Row> rows;
  std::size_t pixels = 0;  ///< of the frame, with a depth
  double everywhere = 0;   ///< one frame's way to a surface by the depth filter, computing time
                           ///< of one thread, median, ms
};

/// Prepares a frame's points at the paper's four sizes, `repeats` times each, and the frame itself
/// as our depth streams do.
/// @throws Error when the frame has fewer points than the paper's largest cloud.
[[nodiscard]] Fig5 measure_fig5(const DepthFrame& frame, int repeats);

}  // namespace palpate::app
