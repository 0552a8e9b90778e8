#pragma once

#include <optional>
#include <vector>

#include "four_cameras/camera_rig.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/sensor/stream.hpp"
#include "servo_cost/paced_servo.hpp"

namespace palpate::four_cameras {

/// The load beside the servo.
enum class Beside {
  still,    ///< nothing; surfaces stand still, so that patches last
  moving,   ///< nothing; surfaces move all the time, as between two frames of a camera
  cameras,  ///< four cameras and their preparation
};

struct RunResult {
  servo_cost::ServoRun servo;
  std::vector<StreamState> streams;
  std::vector<double> ages;  ///< of what was felt, one a millisecond and source, s
};

/// Runs a servo at 1 kHz along `hand` until that ends. `processor`: it is pinned there.
[[nodiscard]] RunResult run_servo(CameraRig& rig, const Trajectory& hand, Beside beside,
                                  WaitingClock& clock, std::optional<int> processor);

}  // namespace palpate::four_cameras
