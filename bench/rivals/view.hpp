#pragma once

#include "accuracy/truth_frame.hpp"
#include "accuracy/truth_scene.hpp"
#include "rivals/rival.hpp"

namespace palpate::rivals {

/// What methods are given of one frame, made once for all of them.
struct View {
  /// `known_spacing`: of the points, m; 0: it is measured.
  explicit View(DepthFrame seen, double known_spacing = 0);
  /// The exact frame with noise, where the scene's camera is.
  View(const accuracy::TruthScene& truth, const DepthFrame& exact,
       const SimulatedNoiseOptions& noise);

  [[nodiscard]] Shown shown(const Method& method) const {
    return {method.needs == Needs::filtered_frame ? &filtered : &frame, &cloud, spacing};
  }

  DepthFrame frame;
  DepthFrame filtered;  ///< after palpate's depth filter, one pixel a block of 2x2
  PointCloud cloud;     ///< the measured pixels as points of the world
  double spacing = 0;   ///< m
};

/// Median over the points of the side of the square that one has to itself, m.
[[nodiscard]] double spacing_of(const PointCloud& cloud);

}  // namespace palpate::rivals
