#pragma once

#include "base/description.hpp"
#include "palpate/depth/depth_filter.hpp"

/// Descriptions of the options of the depth filter.
namespace palpate {

template <EitherConst<DepthFilterOptions> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [noise, error, memory, nearest, farthest] = options;
  take(About{"noise",
             "m",
             {},
             "standard deviation of a depth pixel, S0 + S1 z + S2 z^2 at z metres, and the noise "
             "correlation C >= 1 of neighbouring pixels; or a sensor: kinect1, xtion, realsense, "
             "tof. Default: measured from the frames"},
       noise);
  take(About{"normal_error",
             "rad",
             {.least = 0, .most = 1, .open = true, .words = "a value from 0.001 to 0.1"},
             "how far normals may err: the smaller, the wider the area that a normal is fitted to, "
             "and the less detail",
             files},
       error);
  take(About{"memory",
             "",
             {.least = 1, .words = "1 frame or more"},
             "how many frames a static block of the image averages; 1: every frame by itself",
             files},
       memory);
  // Inverse depths are counted in 31 bits of 2^-20 / m.
  take(About{"nearest",
             "m",
             {.least = 1e-3, .words = "a depth of 0.001 m or more"},
             "the depth filter ignores smaller depths (0.1)"},
       nearest);
  take(About{"farthest", "m", kPositive,
             "the depth filter ignores larger depths (20, or ten times the first frame's median if "
             "that is less)"},
       farthest);
}

}  // namespace palpate
