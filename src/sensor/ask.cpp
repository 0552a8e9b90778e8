#include "sensor/ask.hpp"

#include <exception>

#include "sensor/frame_check.hpp"

namespace palpate::sensor {

CameraStatus ask(DepthCamera& camera, DepthFrame& frame, double timeout, std::string& reason) {
  try {
    const CameraStatus status = camera.read(frame, timeout);
    if (left_out(status) || status == CameraStatus::failed) reason = camera.reason();
    return status;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  return CameraStatus::failed;
}

}  // namespace palpate::sensor
