#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

/// A camera whose frames say where they were taken in a frame of its own (a recording with poses):
/// puts that frame where the user wants it in the world. Frames without a pose are left as they
/// are: the source's pose holds for them.
class PosedCamera final : public DepthCamera {
 public:
  PosedCamera(std::unique_ptr<DepthCamera> camera, const Eigen::Isometry3d& T_world_recording)
      : camera_(std::move(camera)), T_world_recording_(T_world_recording) {}

  [[nodiscard]] const CameraInfo& info() const noexcept override { return camera_->info(); }
  void begin(double start) override { camera_->begin(start); }
  [[nodiscard]] CameraStatus read(DepthFrame& frame, double timeout) override {
    const CameraStatus status = camera_->read(frame, timeout);
    if (status == CameraStatus::frame && frame.T_world_sensor) {
      frame.T_world_sensor = T_world_recording_ * *frame.T_world_sensor;
    }
    return status;
  }
  [[nodiscard]] std::string reason() const override { return camera_->reason(); }

 private:
  std::unique_ptr<DepthCamera> camera_;
  Eigen::Isometry3d T_world_recording_;
};

}  // namespace palpate::app
