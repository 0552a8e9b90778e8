#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "palpate/sensor/depth_camera.hpp"

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
  PrepareTimes here;            ///< wall time on all cores, the fastest
  double weights = 0;           ///< what we do besides: radii and density weights, ms
};

struct Fig5 {
  std::vector<Fig5Row> rows;
  std::size_t pixels = 0;  ///< of the frame, with a depth
  double everywhere = 0;   ///< a frame's way to a surface by the depth filter, computing time of
                           ///< all threads, the fastest, ms
};

/// Prepares the points of the camera's first frame at the paper's four sizes, `repeats` times each,
/// and as many of its frames as our depth streams do.
/// @throws Error when the frame has fewer points than the paper's largest cloud, or the camera
/// gives none.
[[nodiscard]] Fig5 measure_fig5(DepthCamera& camera, int repeats);

}  // namespace palpate::app
