// The plan of a run: all options, read and checked.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/device_options.hpp"
#include "apps/palpate/options/ros_options.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/options/tool_options.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace CLI {
class App;
}

namespace palpate {
class ListeningPort;
}

namespace palpate::app {

struct TouchChoices;

/// The paper's K and ours, N/m.
inline constexpr double kStiffness = 500;

/// Settings of contact, the same for all surfaces.
struct SurfacePlan {
  bool paper = false;  ///< the method of Leeper, Chan and Salisbury 2012
  FieldOptions field = {};
  ProxyOptions proxy = {};                    ///< but for its stiffness:
  std::optional<double> stiffness = {};       ///< N/m in the world; unset: fits the workspace
  std::optional<double> soft_stiffness = {};  ///< where the intensity is lowest, N/m
  std::optional<double> soft_friction = {};   ///< share of it, 0 to 1, there

  /// The proxy of a surface of `hardest` N/m.
  [[nodiscard]] ProxyOptions proxy_of(double hardest) const;

  /// Stiffness of the softest points, where the hardest ones have `hardest` N/m.
  /// @throws UsageError when they would be harder than these.
  [[nodiscard]] SourceOptions::SoftMaterial soft_material(double hardest) const;
};

/// How hands move, and for how long.
struct MotionPlan {
  std::string trajectory = {};          ///< file; empty: they explore
  TrajectoryOptions reading = {};       ///< of that file; with forces: they are compared
  std::string held = {};                ///< how its columns hold a tool; empty: as the usual say
  std::optional<double> duration = {};  ///< s
  std::uint64_t seed = 1;               ///< of the first hand's exploration
  std::optional<double> rate = {};      ///< steps a second, Hz
};

/// Which clock a run goes by, and what holds in real time.
struct TimePlan {
  bool real_time = false;              ///< false: in simulated time
  std::optional<double> latency = {};  ///< from stamp to touchable in simulated time, s
  GuardOptions guard = {};
  bool own_watchdog = false;  ///< its silence was given
  RealtimeOptions realtime = {};
};

/// The page on which a run is seen, touched and set.
struct PagePlan {
  bool wanted = false;                     ///< the run goes on in real time until it is ended
  bool served = false;                     ///< it is there
  bool headless = false;                   ///< opens no browser
  std::string address = {};                ///< empty: this machine alone
  std::string token = {};                  ///< who has it may use the page; empty: a new one
  std::optional<std::uint16_t> port = {};  ///< unset: the first free one from 8420 on
  std::shared_ptr<const ListeningPort> listening = {};  ///< that of the run before on it
  bool paused = false;                                  ///< as the run before on it was
  std::optional<Eigen::Vector3d> up = {};  ///< what is up in the world, 1 long; unset: as it seems
};

/// Files that a run writes; empty: it does not; "-": standard output.
struct OutputPlan {
  std::string log = {};
  std::string json = {};
  std::string picture = {};
  std::string record = {};  ///< never standard output

  [[nodiscard]] bool takes_stdout() const { return log == "-" || json == "-"; }
};

/// All that a command line and a set-up file set of a run, read and checked.
struct TouchPlan {
  std::vector<SourcePlan> sources = {};
  std::vector<DevicePlan> devices = {};  ///< one a hand
  ToolPlan tool = {};
  SurfacePlan surface = {};
  MotionPlan motion = {};
  TimePlan time = {};
  PagePlan page = {};
  RosPlan ros = {};
  OutputPlan outputs = {};
};

/// The plan of what `command` was given, which was parsed into `choices`, and of the set-up file
/// that it names.
/// @throws UsageError when options contradict each other or would change nothing; Error when the
/// set-up file cannot be taken.
[[nodiscard]] TouchPlan plan_touch(const CLI::App& command, TouchChoices choices);

/// May a page give such a run another file to touch? Where people's devices, files that are
/// written or a robot hang on it, it may not.
[[nodiscard]] bool can_open_files(const TouchPlan& plan);

/// The plan of the run after that of `plan`, by hands that explore `sources`, named as on a command
/// line, read and prepared as by default.
[[nodiscard]] TouchPlan plan_of_sources(TouchPlan plan, const std::vector<std::string>& sources);

/// The same run with one of its sources read so that a unit of its file is `metres` long.
[[nodiscard]] TouchPlan plan_in_unit(TouchPlan plan, std::size_t source, double metres);

/// The plan of the run after that of `plan`, by hands that explore what is in the file at `path`,
/// read and prepared as the source was, if it was one.
/// @throws UsageError when that is no source.
[[nodiscard]] TouchPlan plan_of_file(TouchPlan plan, const std::string& path);

}  // namespace palpate::app
