#include "depth/undistort.hpp"

#include <array>
#include <cmath>

namespace palpate::depth {
namespace {

bool same(const CameraModel& a, const CameraModel& b) {
  const auto parts = [](const CameraModel& m) {
    const Pinhole& p = m.pinhole;
    const Distortion& d = m.distortion;
    return std::array{
        double(m.width), double(m.height), p.fx, p.fy, p.cx, p.cy, d.k1, d.k2, d.p1, d.p2, d.k3};
  };
  return parts(a) == parts(b);
}

// Does the distorted radius still grow here? From where it does not, the model means nothing.
bool grows(const Distortion& d, double x, double y) {
  const double r2 = x * x + y * y;
  return 1 + r2 * (3 * d.k1 + r2 * (5 * d.k2 + r2 * 7 * d.k3)) > 0;
}

}  // namespace

ImagePoint distort(const Distortion& d, double x, double y) {
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  return {x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
          y * radial + 2 * d.p2 * x * y + d.p1 * (r2 + 2 * y * y)};
}

void Undistorter::make_map(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  map_.resize(static_cast<std::size_t>(camera.width) * camera.height);
  std::int32_t* to = map_.data();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double x = (u - p.cx) / p.fx;
      const double y = (v - p.cy) / p.fy;
      const ImagePoint at = distort(camera.distortion, x, y);
      const double du = std::round(at.x * p.fx + p.cx);
      const double dv = std::round(at.y * p.fy + p.cy);
      const bool inside = du >= 0 && dv >= 0 && du < camera.width && dv < camera.height &&
                          grows(camera.distortion, x, y);
      *to++ = inside ? static_cast<std::int32_t>(dv) * camera.width + static_cast<std::int32_t>(du)
                     : -1;
    }
  }
  image_.resize(map_.size());
  camera_ = camera;
}

const float* Undistorter::undistort(const CameraModel& camera, const std::vector<float>& depth) {
  if (camera.distortion.none()) return depth.data();
  if (!camera_ || !same(*camera_, camera)) make_map(camera);
  for (std::size_t i = 0; i < map_.size(); ++i) {
    image_[i] = map_[i] < 0 ? 0.0F : depth[static_cast<std::size_t>(map_[i])];
  }
  return image_.data();
}

}  // namespace palpate::depth
