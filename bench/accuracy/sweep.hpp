#pragma once

#include <string>
#include <vector>

#include "accuracy/table.hpp"
#include "base/numbers.hpp"

namespace palpate::accuracy {

/// How a plane is seen, and which way a hand slides over it.
struct PlaneView {
  double distance = 0;   ///< of its place along the optical axis, m
  double incidence = 0;  ///< of the line of sight there, from the normal, rad
  double x = 0, y = 0;   ///< of the place's ray, at a depth of 1
  double about = 0;      ///< direction in which it leans, rad
  double turn = 0;       ///< the slide's direction in the plane, rad
};

/// Draws a view between two distances (m) and the `least` and `most` incidence (degrees), within 5
/// degrees of the optical axis.
[[nodiscard]] PlaneView draw_plane_view(Random& random, double nearest, double farthest,
                                        double least, double most);

/// Makes the plane the scene's first solid. @return a slide over its place, 10 cm long, 3 mm deep
[[nodiscard]] Path put_plane(const PlaneView& view, TruthScene& scene);

/// Slides of 3 mm depth on a plane alone, 10 cm long, and on a sphere of 60 mm radius alone, 30
/// degrees long, in bins of 0.35 to 2.5 m along the optical axis and of 0 to 75 degrees between
/// normal and line of sight. A frame of a bin draws its distance, incidence, place in the image and
/// direction from its seed; there are as many as options.seeds.
[[nodiscard]] BenchResults run_sweep(const BenchOptions& options,
                                     const std::vector<Contender>& contenders);

/// Normal (degrees) / height (mm) by bin, median (worst), as Markdown; with the share of ticks
/// without contact where it is more than half a percent in any frame.
[[nodiscard]] std::string markdown_sweep(const BenchResults& results, const std::string& contender);

}  // namespace palpate::accuracy
