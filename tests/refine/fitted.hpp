// Points a spacing of 1 apart with the plane of each, as segments are made of them.
#pragma once

#include <vector>

#include "prepare/plane_fits.hpp"
#include "refine/segments.hpp"

namespace palpate::test {

inline constexpr float kFittedRadius = 2.5f;  // R

struct Fitted {
  explicit Fitted(const std::vector<Eigen::Vector3f>& points)
      : grid(points),
        spacings(points.size(), 1.f),
        radii(points.size(), kFittedRadius),
        noise(points.size(), 0.f),
        graph(neighborhood_graph(grid, radii)),
        own(fit_points(graph, spacings, radii, noise)) {
    graph.widen(segment_reaches(spacings, radii, true), radii);
  }
  Fitted(const Fitted&) = delete;  // the graph refers to the grid
  Fitted& operator=(const Fitted&) = delete;

  [[nodiscard]] SegmentInput input() const { return {graph, spacings, radii, noise}; }

  CellGrid grid;
  std::vector<float> spacings;
  std::vector<float> radii;
  std::vector<float> noise;
  detail::NeighborhoodGraph graph;
  PointFits own;
};

/// A floor of `side` x `side` points at z = 0 and a wall at x = 0 that stands on it.
inline std::vector<Eigen::Vector3f> floor_and_wall(int side) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      points.emplace_back(i, j, 0);
      if (i > 0) points.emplace_back(0, j, i);
    }
  }
  return points;
}

}  // namespace palpate::test
