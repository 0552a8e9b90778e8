#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

/// A pinhole camera without distortion: pixel (u, v) at depth z is the point
/// ((u - cx) z / fx, (v - cy) z / fy, z), x right, y down, z forward.
struct Pinhole {
  double fx = 0;  ///< pixels
  double fy = 0;
  double cx = 0;
  double cy = 0;
};

/// Maps a depth camera's frame (x right, y down, z forward) to pixels.
struct CameraModel {
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

  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Pinhole pinhole;
  Distortion distortion;
};

/// Image of a depth camera. to_metres() converts depths in 16 bits.
struct DepthFrame {
  CameraModel camera;
  double stamp = 0;  ///< when it was taken, s, on the host's clock
  std::optional<Eigen::Isometry3d>
      T_world_sensor;        ///< at the stamp; unset: where the source stands
  std::vector<float> depth;  ///< along the optical axis, m, row by row; 0: nothing measured
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< of the same pixels; may be empty
  /// Points in the sensor's frame, instead of depths and camera, if the sensor delivers points.
  std::shared_ptr<const PointCloud> cloud;
};

/// 16-bit depth, as cameras, drivers and files give it, in metres, as a DepthFrame holds it:
///
///   frame.depth.resize(samples.size());
///   to_metres(samples, 1e-3, frame.depth);  // millimetres
///
/// `unit`: metres a step. 0 and 65535 become 0: nothing was measured there, or it was too far
/// away. Other values that a sensor marks such pixels with are to be made 0 before. Takes no
/// memory; any thread; a row at a time where rows do not follow one another in memory.
/// @throws Error when the unit is not finite or not above 0, or the two differ in size.
void to_metres(std::span<const std::uint16_t> samples, double unit, std::span<float> depth);

/// The image that an organised cloud was made of.
struct OrganisedFrame {
  /// Its stamp is 0, its T_world_sensor the camera's pose in the cloud's frame; unset where that is
  /// the cloud's frame itself. Unset as a whole: no pinhole camera sees the points in these pixels.
  std::optional<DepthFrame> frame;
  double residual = 0;   ///< rms distance of points from the middles of their pixels, pixels
  std::string why_none;  ///< why there is no frame, in words
};

/// Finds the camera, and the direction that it looked in, from the points themselves: a pinhole
/// sees each in its pixel. It has to have stood at the cloud's viewpoint or origin. Points that
/// were moved, where they are no more than a hundredth, are left out. Any thread; some 50 ms for
/// 640 x 480.
[[nodiscard]] OrganisedFrame depth_frame_of(const PointCloud& cloud);

}  // namespace palpate
