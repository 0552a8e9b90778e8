#pragma once

#include <memory>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/base/driver_info.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate {

struct CameraOptions {
  /// Clock of the stamps; outlives the camera. Recordings and simulated cameras also wait for
  /// it; null: they are as fast as they are asked, and real cameras stamp by the host's clock.
  const Clock* clock = nullptr;
  bool loop = false;  ///< recordings begin again at the end
};

/// Opens a camera by name: "simulated[:SCENE[,KEY=VALUE]...]" (docs/simulated_cameras.md),
/// "sequence:DIR" (docs/sequences.md), "openni2[:URI]" (PrimeSense, Xtion; without URI the first
/// that is there), "openni2:FILE.oni" or just "FILE.oni", "freenect[:NUMBER]" (Kinect v1; the first
/// is 0), "ros:TOPIC[,frame=FRAME]" (docs/ros2.md). Set-up: one thread at a time.
/// @throws Error when the name is none of these, when the build lacks the driver, when there is no
///   such camera, it is in use or may not be used; says what to do.
[[nodiscard]] std::unique_ptr<DepthCamera> open_camera(const std::string& name,
                                                       const CameraOptions& options = {});

/// Every driver, with what it finds. Set-up: one thread at a time; may take a second.
[[nodiscard]] std::vector<DriverInfo> list_cameras();

}  // namespace palpate
