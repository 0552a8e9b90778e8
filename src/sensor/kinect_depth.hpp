#pragma once

#include <cstdint>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {

/// The depth camera of a Kinect v1 (and its PrimeSense relatives) by its maker's nominal values;
/// single devices differ from them by about a percent.
[[nodiscard]] Pinhole kinect_pinhole(int width, int height);

/// Metres of a raw 11-bit value, the disparity in eighths of a pixel against a reference plane at
/// 1.2 m. 0 for 2047 and above ("nothing measured") and for what is beyond 15 m.
[[nodiscard]] float kinect_metres(std::uint16_t raw);

}  // namespace palpate::sensor
