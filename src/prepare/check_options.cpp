#include "prepare/check_options.hpp"

#include <fmt/core.h>

#include <cmath>

#include "palpate/base/error.hpp"
#include "prepare/given_signs.hpp"

namespace palpate {
namespace {

void require(bool condition, const char* option, double value, const char* range) {
  if (condition) return;
  throw Error(fmt::format("preparation option {} is {}: it must be {}", option, value, range));
}

}  // namespace

void check(const PrepareOptions& options, const PointCloud& cloud) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  if (options.voxel) {
    require(*options.voxel == 0 || positive(*options.voxel), "voxel", *options.voxel,
            "0 (keep every point) or a length in metres");
  }
  if (options.radius) {
    require(positive(*options.radius), "radius", *options.radius, "a length above 0, in metres");
  }
  if (options.radius_multiple) {
    require(positive(*options.radius_multiple), "radius_multiple", *options.radius_multiple,
            "above 0 (2.5 unless there is a reason)");
  }
  require(options.minimum_radius >= 0 && std::isfinite(options.minimum_radius), "minimum_radius",
          options.minimum_radius, "0 or a length in metres");
  require(positive(options.normal_error), "normal_error", options.normal_error,
          "an angle above 0, in radians");
  if (options.orientation == Orientation::viewpoint && !options.viewpoint && !cloud.viewpoint) {
    throw Error("normals are to point to the viewpoint, but none is known; give one");
  }
  if (options.orientation == Orientation::given && share_given(cloud.normals) == 0) {
    throw Error("normals are to be as given, but the cloud has none");
  }
  if (options.material_from_intensity && cloud.intensities.empty()) {
    throw Error("materials are to come from intensities, but the cloud has none");
  }
}

}  // namespace palpate
