#pragma once

#include <string>
#include <vector>

#include "accuracy/bench_run.hpp"
#include "rivals/rival.hpp"

/// All methods on the drawn scenes of table A, under its scores.
namespace palpate::rivals {

struct CompareOptions {
  std::vector<Method> methods;
  accuracy::BenchOptions bench;  ///< layouts, seeds and noise
  int threads = 2;               ///< layouts at a time; results do not depend on it
};

/// Computing times of a method in one frame. They differ from run to run.
struct Times {
  std::string method;
  double show = 0;  ///< ms
  double p50 = 0;   ///< of a step, us
  double p99 = 0;
};

struct Compared {
  accuracy::BenchResults scores;  ///< `contender` is the method's name
  std::vector<Times> times;
};

[[nodiscard]] Compared compare(const CompareOptions& options);

/// What methods are given of one noisy frame.
struct View {
  View(const accuracy::TruthScene& truth, const DepthFrame& exact,
       const SimulatedNoiseOptions& noise);

  [[nodiscard]] Shown shown(const Method& method) const {
    return {method.filtered ? &filtered : &frame, &cloud, spacing};
  }

  DepthFrame frame;
  DepthFrame filtered;
  PointCloud cloud;
  double spacing = 0;
};

/// The frame after palpate's depth filter, one pixel a block of 2x2.
[[nodiscard]] DepthFrame filtered_frame(const DepthFrame& frame);

/// The measured pixels as points of the world.
[[nodiscard]] PointCloud world_cloud(const DepthFrame& frame);

/// Median over the points of the side of the square that one has to itself, m.
[[nodiscard]] double spacing_of(const PointCloud& cloud);

/// The method's forces along a path.
[[nodiscard]] accuracy::Trace felt(Rival& rival, const accuracy::Path& path);

}  // namespace palpate::rivals
