// Checks frames and options of the depth filter, and removes the lens's distortion from images.
#include "depth/input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "depth/blocks.hpp"
#include "depth/description.hpp"
#include "geometry/rotation.hpp"
#include "palpate/base/error.hpp"

namespace palpate::depth {
namespace {

void check(const NoiseModel& noise, const DepthFilterOptions& options) {
  for (const double z : {options.nearest, options.farthest}) {
    if (!(noise.sigma(z) > 0 && std::isfinite(noise.sigma(z)))) {
      throw Error(
          fmt::format("depth filter: the noise at {} m is {} m; give a model that is positive from "
                      "nearest to farthest depth",
                      z, noise.sigma(z)));
    }
  }
  if (!(noise.correlation >= 1 && std::isfinite(noise.correlation))) {
    throw Error(fmt::format(
        "depth filter: the noise correlation is {}; give 1 (independent pixels) or more",
        noise.correlation));
  }
}

}  // namespace

void check(const DepthFilterOptions& options) {
  check_described("depth filter", options);
  if (!(options.farthest > options.nearest)) {
    throw Error(fmt::format(
        "depth filter: {} to {} m is not a valid depth range; give 0.001 <= nearest < farthest",
        options.nearest, options.farthest));
  }
  if (options.noise) check(*options.noise, options);
}

void check(const DepthFrame& frame) {
  const CameraModel& camera = frame.camera;
  if (camera.width < 2 || camera.height < 2) {
    throw Error(
        fmt::format("depth filter: a frame of {} x {} pixels is smaller than one block of 2 x 2; "
                    "give the camera's width and height",
                    camera.width, camera.height));
  }
  if (camera.width < kFewestPixels || camera.height < kFewestPixels) {
    throw Error(
        fmt::format("depth filter: a frame of {} x {} pixels is too small to estimate slopes; give "
                    "at least {} in each direction",
                    camera.width, camera.height, kFewestPixels));
  }
  const auto pixels = static_cast<std::uint64_t>(camera.width) * camera.height;
  if (frame.depth.size() != pixels) {
    throw Error(fmt::format("depth filter: {} depths for {} x {} pixels; give {}",
                            frame.depth.size(), camera.width, camera.height, pixels));
  }
  const Pinhole& p = camera.pinhole;
  const bool is_camera = p.fx > 0 && p.fy > 0 && std::isfinite(p.fx) && std::isfinite(p.fy) &&
                         std::isfinite(p.cx) && std::isfinite(p.cy);
  if (!is_camera) {
    throw Error(
        fmt::format("depth filter: fx {}, fy {}, cx {}, cy {} are not valid intrinsics; give focal "
                    "lengths and principal point in pixels",
                    p.fx, p.fy, p.cx, p.cy));
  }
}

void check(const Eigen::Isometry3d& T_world_sensor) {
  if (!T_world_sensor.matrix().allFinite()) {
    throw Error("depth filter: the sensor pose is not finite; give a finite one");
  }
  if (is_rotation(T_world_sensor.linear())) return;
  throw Error("depth filter: the sensor pose scales, shears or mirrors; give a rigid one");
}

namespace {

bool same(const CameraModel& a, const CameraModel& b) {
  const auto parts = [](const CameraModel& m) {
    const Pinhole& p = m.pinhole;
    const CameraModel::Distortion& d = m.distortion;
    return std::array{
        double(m.width), double(m.height), p.fx, p.fy, p.cx, p.cy, d.k1, d.k2, d.p1, d.p2, d.k3};
  };
  return parts(a) == parts(b);
}

// Does the distorted radius still grow here? From where it does not, the model means nothing.
bool grows(const CameraModel::Distortion& d, double x, double y) {
  const double r2 = x * x + y * y;
  return 1 + r2 * (3 * d.k1 + r2 * (5 * d.k2 + r2 * 7 * d.k3)) > 0;
}

// A coordinate between the pixels of a row or a column.
struct Position {
  bool inside = false;
  int nearest = 0;
  int next = 0;     // on the side where it lies; at the image's border the nearest one itself
  float apart = 0;  // from the nearest one towards the next
};

Position position_of(double coordinate, int size) {
  const double nearest = std::round(coordinate);
  if (!(nearest >= 0 && nearest < size)) return {};
  const double apart = coordinate - nearest;
  const int pixel = static_cast<int>(nearest);
  return {true, pixel, std::clamp(pixel + (apart < 0 ? -1 : 1), 0, size - 1),
          static_cast<float>(std::abs(apart))};
}

// False too for an `other` that is no depth.
bool same_surface(const simd::DepthGate& gate, float z, float other) {
  const float width = gate.width[0] + z * (gate.width[1] + z * gate.width[2]);
  return other >= gate.nearest && std::abs(other - z) <= width;
}

}  // namespace

bool is_in_lens(const CameraModel::Distortion& d, double x, double y) {
  if (d.none()) return true;
  constexpr int kSteps = 8;  // a polynomial of degree 6 in the radius turns more slowly
  for (int i = 1; i <= kSteps; ++i) {
    if (!grows(d, x * i / kSteps, y * i / kSteps)) return false;
  }
  return true;
}

ImagePoint distort(const CameraModel::Distortion& d, double x, double y) {
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  return {x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
          y * radial + 2 * d.p2 * x * y + d.p1 * (r2 + 2 * y * y)};
}

Undistorter::Origin Undistorter::origin_of(const CameraModel& camera, int u, int v) {
  const Pinhole& p = camera.pinhole;
  const double x = (u - p.cx) / p.fx;
  const double y = (v - p.cy) / p.fy;
  const ImagePoint at = distort(camera.distortion, x, y);
  const Position across = position_of(at.x * p.fx + p.cx, camera.width);
  const Position down = position_of(at.y * p.fy + p.cy, camera.height);
  if (!across.inside || !down.inside || !grows(camera.distortion, x, y)) return {};
  const auto pixel = [&](int column, int row) { return row * camera.width + column; };
  return {pixel(across.nearest, down.nearest), pixel(across.next, down.nearest),
          pixel(across.nearest, down.next), across.apart, down.apart};
}

float Undistorter::Origin::depth_in(const float* image, const simd::DepthGate& gate) const {
  const float z = nearest < 0 ? 0.0F : image[nearest];
  if (!(z >= gate.nearest && z <= gate.farthest)) return 0;
  const auto ratio = [&](std::int32_t neighbor) {
    return same_surface(gate, z, image[neighbor]) ? z / image[neighbor] : 1.0F;
  };
  return z / (1 + across * (ratio(beside) - 1) + down * (ratio(below) - 1));
}

void Undistorter::make_map(const CameraModel& camera) {
  map_.clear();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) map_.push_back(origin_of(camera, u, v));
  }
  image_.resize(map_.size());
  camera_ = camera;
}

const float* Undistorter::undistort(const CameraModel& camera, const std::vector<float>& depth,
                                    const NoiseModel& noise, const DepthFilterOptions& range) {
  if (camera.distortion.none()) return depth.data();
  if (!camera_ || !same(*camera_, camera)) make_map(camera);
  const simd::DepthGate gate = depth_gate(block_grid(camera), 1, noise, range);
  std::ranges::transform(map_, image_.begin(),
                         [&](const Origin& from) { return from.depth_in(depth.data(), gate); });
  return image_.data();
}

}  // namespace palpate::depth
