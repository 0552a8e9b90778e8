#pragma once

namespace palpate {

/// A pinhole camera without distortion: pixel (u, v) at depth z is the point
/// ((u - cx) z / fx, (v - cy) z / fy, z), x right, y down, z forward.
struct Pinhole {
  double fx = 0;  ///< pixels
  double fy = 0;
  double cx = 0;
  double cy = 0;
};

}  // namespace palpate
