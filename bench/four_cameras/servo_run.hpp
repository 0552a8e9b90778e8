#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "four_cameras/camera_rig.hpp"
#include "palpate/sensor/stream_state.hpp"
#include "palpate/servo/histogram.hpp"
#include "palpate/servo/realtime.hpp"

namespace palpate::four_cameras {

/// What else goes on while the servo runs.
enum class Beside {
  still,    ///< nothing; surfaces stand still, so that patches last
  moving,   ///< nothing; surfaces move all the time, as between two frames of a camera
  cameras,  ///< four cameras and their preparation
};

struct RunResult {
  std::vector<double> computing;  ///< thread time of every step, s; in rising order
  Durations lateness;
  std::uint64_t steps = 0;
  std::uint64_t skipped = 0;
  std::uint64_t touching = 0;
  std::uint64_t faults = 0;
  std::int64_t lock_waits = 0;  ///< times the servo's thread slept for anything but the clock
  std::vector<StreamState> streams;
  std::vector<double> ages;  ///< of what was felt, one a millisecond and source, s
  RealtimeReport realtime;
};

/// Runs a servo at 1 kHz along `hand` until that ends. `processor`: it is pinned there.
[[nodiscard]] RunResult run_servo(CameraRig& rig, const Trajectory& hand, Beside beside,
                                  WaitingClock& clock, std::optional<int> processor);

}  // namespace palpate::four_cameras
