#pragma once

#include "palpate/geometry/pinhole.hpp"

namespace palpate {

/// Lens distortion after Brown and Conrady, on normalised image coordinates x, y with
/// r^2 = x^2 + y^2: x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), and y'
/// alike with p1 and p2 exchanged.
struct Distortion {
  double k1 = 0;
  double k2 = 0;
  double p1 = 0;
  double p2 = 0;
  double k3 = 0;

  [[nodiscard]] bool none() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0; }
};

/// How a depth camera maps its frame (x right, y down, z forward) to pixels.
struct CameraModel {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Pinhole pinhole;
  Distortion distortion;
};

}  // namespace palpate
