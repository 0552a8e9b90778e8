#include "depth/check_input.hpp"

#include <fmt/format.h>

#include <cmath>

#include "palpate/base/error.hpp"

namespace palpate::depth {
namespace {

void check(const NoiseModel& noise, const DepthFilterOptions& options) {
  for (const double z : {options.nearest, options.farthest}) {
    if (!(noise.sigma(z) > 0 && std::isfinite(noise.sigma(z)))) {
      throw Error(
          fmt::format("depth filter: the noise at {} m is {} m; give a model that is "
                      "positive from nearest to farthest",
                      z, noise.sigma(z)));
    }
  }
  if (!(noise.correlation >= 1 && std::isfinite(noise.correlation))) {
    throw Error(
        fmt::format("depth filter: the noise's correlation is {}; take 1 (independent "
                    "pixels) or more",
                    noise.correlation));
  }
}

}  // namespace

void check(const DepthFilterOptions& options) {
  if (!(options.normal_error > 0 && options.normal_error < 1)) {
    throw Error(fmt::format("depth filter: normal_error is {} rad; take a value from 0.001 to 0.1",
                            options.normal_error));
  }
  if (options.memory < 1) {
    throw Error(fmt::format("depth filter: memory is {} frames; take 1 or more", options.memory));
  }
  constexpr double kClosest = 1e-3;  // m; inverse depths are counted in 31 bits of 2^-20 / m
  const bool range = options.nearest >= kClosest && options.farthest > options.nearest &&
                     std::isfinite(options.farthest);
  if (!range) {
    throw Error(
        fmt::format("depth filter: depths from {} to {} m are none; take 0.001 <= nearest < "
                    "farthest",
                    options.nearest, options.farthest));
  }
  if (options.noise) check(*options.noise, options);
}

void check(const DepthFrame& frame) {
  const CameraModel& camera = frame.camera;
  if (camera.width < 2 || camera.height < 2) {
    throw Error(
        fmt::format("depth filter: a frame of {} x {} pixels has no block of 2 x 2; give "
                    "the camera's width and height",
                    camera.width, camera.height));
  }
  if (camera.width < kFewestPixels || camera.height < kFewestPixels) {
    throw Error(
        fmt::format("depth filter: a frame of {} x {} pixels has too few to tell slopes from; give "
                    "{} or more each way",
                    camera.width, camera.height, kFewestPixels));
  }
  const auto pixels = static_cast<std::size_t>(camera.width) * camera.height;
  if (frame.depth.size() != pixels) {
    throw Error(fmt::format("depth filter: {} depths for {} x {} pixels; give {}",
                            frame.depth.size(), camera.width, camera.height, pixels));
  }
  const Pinhole& p = camera.pinhole;
  const bool is_camera = p.fx > 0 && p.fy > 0 && std::isfinite(p.fx) && std::isfinite(p.fy) &&
                         std::isfinite(p.cx) && std::isfinite(p.cy);
  if (!is_camera) {
    throw Error(
        fmt::format("depth filter: a pinhole with fx {}, fy {}, cx {}, cy {} is none; give "
                    "the focal lengths and the centre in pixels",
                    p.fx, p.fy, p.cx, p.cy));
  }
}

void check(const Eigen::Isometry3d& T_world_sensor) {
  if (T_world_sensor.matrix().allFinite()) return;
  throw Error("depth filter: the sensor's pose is not finite; give one that is");
}

}  // namespace palpate::depth
