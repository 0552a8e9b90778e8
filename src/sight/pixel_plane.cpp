// Fits planes to windows of pixels, in inverse depth.
#include "sight/pixel_plane.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace palpate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

PixelWindow window_of(const DepthFrame& frame, double u, double v, int half) {
  PixelWindow found;
  const int across = static_cast<int>(std::lround(u));
  const int down = static_cast<int>(std::lround(v));
  for (int y = std::max(down - half, 0); y <= std::min(down + half, frame.camera.height - 1); ++y) {
    for (int x = std::max(across - half, 0); x <= std::min(across + half, frame.camera.width - 1);
         ++x) {
      const float z = frame.depth[static_cast<std::size_t>(y) * frame.camera.width + x];
      if (!(z > 0 && std::isfinite(z))) continue;
      found.all[found.count++] = {x - u, y - v, 1 / static_cast<double>(z)};
    }
  }
  return found;
}

PixelPlane plane_of(std::span<const Pixel> pixels) {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
  Vector3d right = Vector3d::Zero();
  double squares = 0;
  for (const Pixel& pixel : pixels) {
    u += pixel.u;
    v += pixel.v;
    uu += pixel.u * pixel.u;
    uv += pixel.u * pixel.v;
    vv += pixel.v * pixel.v;
    right += pixel.inverse * Vector3d(1, pixel.u, pixel.v);
    squares += pixel.inverse * pixel.inverse;
  }
  const auto count = static_cast<double>(pixels.size());
  const Matrix3d normal{{count, u, v}, {u, uu, uv}, {v, uv, vv}};
  Matrix3d inverse;
  bool solved = false;
  normal.computeInverseWithCheck(inverse, solved);
  if (!solved) return {};
  const Vector3d plane = inverse * right;
  const double rest = std::max(squares - plane.dot(right), 0.0);  // of the squares
  return {plane.x(), inverse(0, 0), std::sqrt(rest / std::max(count - 3, 1.0))};
}

std::span<Pixel> own_surface(std::span<Pixel> pixels) {
  const auto distance = [](const Pixel& p) { return p.u * p.u + p.v * p.v; };
  const double own = std::ranges::min(pixels, {}, distance).inverse;
  std::ranges::sort(pixels, {}, &Pixel::inverse);
  std::size_t cut = 1;
  for (std::size_t i = 2; i < pixels.size(); ++i) {
    if (pixels[i].inverse - pixels[i - 1].inverse > pixels[cut].inverse - pixels[cut - 1].inverse)
      cut = i;
  }
  return own < pixels[cut].inverse ? pixels.first(cut) : pixels.subspan(cut);
}

}  // namespace palpate
