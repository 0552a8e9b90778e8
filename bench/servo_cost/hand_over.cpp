#include "servo_cost/hand_over.hpp"

#include "device/explore.hpp"

namespace palpate::servo_cost {

namespace {

constexpr double kPatch = 0.15;  // that the hand explores, m
constexpr double kDepth = 3e-3;  // m

}  // namespace

Trajectory hand_over(const Scene& scene, double seconds) {
  const auto points = scene.source(0).points();
  StrokeOptions options;
  options.duration = seconds;
  options.radius = points->radius;
  options.depth = kDepth;
  options.patch = kPatch;
  return explore({points->origin, points->grid.points(), points->normals}, options);
}

}  // namespace palpate::servo_cost
