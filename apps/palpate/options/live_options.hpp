#pragma once

#include <optional>

#include "palpate/servo/guard.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// What a run in real time is held to, and asks the system for. What is not set is as GuardOptions
/// and RealtimeOptions have it.
struct LiveOptions {
  std::optional<double> maximum_force;  ///< N; lowered to what the device can hold
  std::optional<double> slew;           ///< N/s
  std::optional<double> watchdog;       ///< s
  std::optional<double> damping;        ///< of the guard's damper, N s/m
  std::optional<double> soft_start;     ///< s
  bool passivity = true;                ///< the guard takes back energy that the hand was given
  std::optional<int> processor;         ///< that the servo's thread is pinned to
  std::optional<int> priority;          ///< of the servo's thread
  bool realtime = true;                 ///< ask for real-time priority
  bool lock_memory = true;              ///< ask for memory that stays
};

/// Adds the options of the command line.
void add_live_options(CLI::App& command, LiveOptions& options);

/// Adds those that a set-up file alone has.
void add_live_setup_options(CLI::App& file, LiveOptions& options);

/// The guard that is asked for.
[[nodiscard]] GuardOptions guard_options(const LiveOptions& options);

/// What is asked of the system.
[[nodiscard]] RealtimeOptions realtime_options(const LiveOptions& options);

}  // namespace palpate::app
