#pragma once

#include <string>

#include "palpate/sensor/depth_camera.hpp"

namespace palpate::sensor {

/// DepthCamera::read() of a camera that may also throw: it has failed then. `reason` says why where
/// no whole frame came, and is left as it is otherwise.
[[nodiscard]] CameraStatus ask(DepthCamera& camera, DepthFrame& frame, double timeout,
                               std::string& reason);

}  // namespace palpate::sensor
