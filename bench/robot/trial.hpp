#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/rows.hpp"
#include "common/stage.hpp"
#include "sim/simulated_camera.hpp"

/// Trials of what a robot that follows the proxy is told, and how they are scored.
namespace palpate::robot {

using bench::kTick;
using bench::kUp;

inline constexpr double kEnd = 8;        ///< s; judgement: long enough to come twice
inline constexpr double kHappens = 2.5;  ///< s, when things begin to happen; judgement

/// A camera, how long its frames are on their way, and what spoils them.
struct Watcher {
  SimulatedCameraOptions options;
  double delay = 0;                             ///< s
  std::function<bool(DepthFrame&)> fault = {};  ///< false: the frame never arrives
};

/// A trial: a robot follows the proxy of a hand before cameras. It has a floor z = 0 that cameras
/// look at from 0.5 to 0.9 m, and a hand over it.
struct Trial : bench::Stage {
  /// Draws the floor and a camera.
  explicit Trial(std::uint64_t number);

  Watcher& camera();
  SimulatedSolid& floor() { return scene.solids.front(); }
  void floor_rises(double speed, double way, double begin = kHappens) {
    moves(floor(), speed * kUp, begin, way / speed);
  }
  /// Where the hand is when things begin to happen.
  [[nodiscard]] const Eigen::Vector3d& hand_then() const {
    return hip[static_cast<std::size_t>(kHappens / kTick)];
  }
  /// The hand stays until then (s).
  void hold_until(double time);
  /// The hand hovers or presses when things happen; later it is lifted and comes again.
  void hand();
  /// Nothing is measured in a disc around where the hand is.
  void hole(Watcher& watcher, double from, double lasts);

  std::vector<Watcher> cameras;
  double tool_radius = 0;  ///< m
};

using Row = bench::Row<Trial>;
[[nodiscard]] std::vector<Row> all_rows();

/// The robot's targets in one trial. Depths are in solids of the truth, mm; 0: in front.
struct Score {
  double told = 0;       ///< targets
  double waits = 0;      ///< share of the time
  double needless = 0;   ///< share of it in waits that began with the tool in plain sight
  double again = 0;      ///< s; longest part of a wait in which hand and tool were free in sight
  double deepest = 0;    ///< of targets
  double unexcused = 0;  ///< and deep in the newest frame that had arrived, too: nothing excuses it
  double beyond = 0;     ///< deepest beyond noise and one frame's motion (allowance.hpp)
  double late = 0;       ///< and deep in one that had arrived 0.1 s before
  double sigma = 0;      ///< of a pixel there, mm
  double back_depth = 0;  ///< deepest place that it was told on its way back
  double back_speed = 0;  ///< m/s
  double hand_moves = 0;  ///< longest jump of a target beyond the hand's own way in that time
  std::string reasons;    ///< s of waiting each
  std::string where;      ///< the target that was deepest beyond; empty: none was
};

enum class Rule { seen_free, proxy };  ///< `proxy`: as before places were looked at

[[nodiscard]] Score play(const Trial& trial, Rule rule);

}  // namespace palpate::robot
