#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/simulated_camera.hpp"

namespace palpate::robot {

inline constexpr double kTick = 1e-3;    // s
inline constexpr double kEnd = 8;        // s
inline constexpr double kHappens = 2.5;  // s, when things begin to happen

/// A camera, how long its frames are on their way, and what spoils them.
struct Watcher {
  SimulatedCameraOptions options;
  double delay = 0;                             ///< s
  std::function<bool(DepthFrame&)> fault = {};  ///< false: the frame never arrives
};

/// What a hand does before cameras while a robot follows its proxy.
struct Trial {
  SimulatedScene scene;
  std::vector<Watcher> cameras;
  std::vector<Eigen::Vector3d> hip;  ///< m, tick by tick
  double tool_radius = 0;            ///< m
};

/// One kind of trial; a seed says which one.
struct Row {
  std::string name;
  std::function<Trial(std::uint64_t)> make;
};
[[nodiscard]] std::vector<Row> all_rows();

/// What the robot was told in one trial. Depths are in solids of the truth, mm; 0: in front.
struct Score {
  long told = 0;         ///< targets
  double waits = 0;      ///< share of the time
  double needless = 0;   ///< share of it in waits that began with the tool in plain sight
  double deepest = 0;    ///< of targets
  double unexcused = 0;  ///< and deep in the newest frame that had arrived, too: nothing excuses it
  double late = 0;       ///< and deep in one that had arrived 0.1 s before
  double sigma = 0;      ///< of a pixel there, mm
  double back_depth = 0;  ///< deepest place that it was told on its way back
  double back_speed = 0;  ///< m/s
  double hand_moves = 0;  ///< longest jump of a target beyond the hand's own way in that time
  std::string reasons;    ///< s of waiting each
};

enum class Rule { seen_free, proxy };  ///< `proxy`: as before places were looked at

[[nodiscard]] Score play(const Trial& trial, Rule rule);

}  // namespace palpate::robot
