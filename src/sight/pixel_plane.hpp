// A plane through the pixels around a point of a depth image.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "palpate/depth/depth_filter.hpp"

namespace palpate {

inline constexpr int kHalfWindow =
    2;  // pixels: a window of 5 x 5 averages most noise and bends little
inline constexpr int kWideWindow =
    2 * kHalfWindow;  // pixels: as far again beyond that window on each side (derived)
inline constexpr double kMostLeverage = 1;  // pixels extrapolated so far are worth less than one

/// A pixel's inverse depth, which is affine in the pixel on planes.
struct Pixel {
  double u = 0;  // from the requested position, pixels
  double v = 0;
  double inverse = 0;  // 1/m
};

struct PixelWindow {
  std::array<Pixel, (2 * kWideWindow + 1) * (2 * kWideWindow + 1)> all;
  std::size_t count = 0;

  [[nodiscard]] std::span<Pixel> span() { return {all.data(), count}; }
};

/// A plane through pixels: its inverse depth at the requested position.
struct PixelPlane {
  double inverse = 0;
  double leverage = std::numeric_limits<double>::infinity();  // its variance over a pixel's
  double residual = 0;                                        // rms, 1/m

  [[nodiscard]] bool valid() const { return leverage <= kMostLeverage && inverse > 0; }
};

/// The pixels around a point of the image that measured something, up to `half` to each side, which
/// is kWideWindow at most.
[[nodiscard]] PixelWindow window_of(const DepthFrame& frame, double u, double v, int half);

[[nodiscard]] PixelPlane plane_of(std::span<const Pixel> pixels);

/// The pixels on one side of the widest gap between depths: the side of the pixel that is nearest
/// to the point.
[[nodiscard]] std::span<Pixel> own_surface(std::span<Pixel> pixels);

}  // namespace palpate
