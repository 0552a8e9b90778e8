#pragma once

#include <string>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::streams {

/// One surface and the proxy on it.
struct Tool {
  std::string name;
  FieldOptions field;
  ProxyOptions proxy;
};

/// One way from frames to a surface in time, felt with several tools at once.
struct Contender {
  std::string name;
  SourceOptions source;
  bool clouds = false;  ///< pixels near the path are pushed as points, not frames
  std::vector<Tool> tools;
};

/// metaball, pointset and balanced under the converged proxy.
[[nodiscard]] std::vector<Tool> our_tools();

/// The paper's two surfaces under its single-step proxy.
[[nodiscard]] std::vector<Tool> paper_tools();

/// The default for depth frames, felt with our_tools(), or with `balanced` alone.
[[nodiscard]] Contender morph();
[[nodiscard]] Contender default_way();

/// Clouds under `policy` with N = `history`, prepared alike: voxels of 4 mm, R = 10 mm.
[[nodiscard]] Contender of_clouds(Policy policy, int history);

/// The paper's way: N clouds of voxels of 4 mm that count 1/N each and are swapped at once, its
/// surfaces, R = 10 mm.
[[nodiscard]] Contender papers_way(int history);

/// The same with R = 5.1 mm, for Fig. 7: 2.5 times the mean distance to the nearest neighbour.
[[nodiscard]] Contender papers_figure(int history);

}  // namespace palpate::streams
