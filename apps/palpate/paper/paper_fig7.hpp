#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

/// One moment of a press, in the frame of the surface.
struct PressSample {
  double height = 0;  ///< of the proxy over its mean, along the surface's normal, m
  double nx = 0;      ///< tangential components of the field's normal at the proxy
  double ny = 0;
  double force = 0;  ///< N
};

/// One way of feeling the surface.
struct Press {
  std::string name;   ///< "metaball", "point-set", "palpate"
  int clouds = 0;     ///< N; 0: our default, which keeps no clouds
  double radius = 0;  ///< R at the test point (median), m
  std::vector<PressSample> samples;

  // Over the samples:
  double height_sd = 0;  ///< m
  double nx_sd = 0;      ///< rad
  double ny_sd = 0;      ///< rad
  double jump = 0;       ///< largest change of the force from one servo step to the next, N
  double touching = 0;   ///< share of steps
};

struct Fig7 {
  std::vector<Press> presses;
  std::vector<double> times;  ///< of the samples, s
  double depth = 0;           ///< of the test point, along the optical axis, m
  double angle = 0;           ///< between optical axis and surface, rad
  double voxel = 0;           ///< of the paper's clouds, m
  bool radius_given = false;
  std::size_t frames = 0;
};

struct Fig7Options {
  double duration = 4;                ///< of the press, s
  double voxel = 4e-3;                ///< of the paper's clouds, m
  std::optional<double> radius = {};  ///< R of the paper's clouds, m; unset: 2.5 s
};

/// The paper's test of stability over time: a hand held 4 mm deep in the surface in the middle of
/// the image, felt in nine ways at once, from the same frames.
/// @throws Error when the camera ends or fails before the press does.
[[nodiscard]] Fig7 measure_fig7(DepthCamera& camera, const Fig7Options& options);

}  // namespace palpate::app
