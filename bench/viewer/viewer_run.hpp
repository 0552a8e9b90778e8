#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/viewer/viewer.hpp"
#include "servo_cost/paced_servo.hpp"
#include "viewer/viewer_client.hpp"

namespace palpate::viewer_bench {

/// The load beside the servo.
struct Beside {
  bool clients = false;  ///< a viewer and eight of them
  bool renewed = false;  ///< the cloud comes anew ten times a second
};

struct RunResult {
  servo_cost::ServoRun servo;
  Viewer::Counts counts;              ///< at the servo's end
  std::vector<ClientReport> clients;  ///< of those that read
};

/// A source with `count` points on a bumpy sphere of 0.1 m, every one of which is felt.
void add_cloud(Scene& scene, std::size_t count);

/// Runs a servo at 1 kHz along `hand` until that ends. `processor`: it is pinned there.
[[nodiscard]] RunResult run_servo(Scene& scene, const Trajectory& hand, Beside beside,
                                  WaitingClock& clock, std::optional<int> processor);

}  // namespace palpate::viewer_bench
