// The parts of a run: hands, devices, feeds.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "apps/palpate/options/touch_plan.hpp"
#include "apps/palpate/run/named_tool.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/remote.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

class Opening;
class Recorder;

/// Who touches: a device, where it stands, and the surface's stiffness that goes with it.
struct Hand {
  std::string name;                      ///< for messages
  DevicePlan chosen;                     ///< what is to be at the hand
  std::unique_ptr<RemoteTarget> remote;  ///< takes the tool from its trajectory; null: nobody can
  std::unique_ptr<TeleoperatedHand> guide;  ///< what pulls the hand and listens to `remote`
  std::unique_ptr<Device> device;
  const RemoteDevice* socket = nullptr;  ///< the device, where it is another program's
  Workspace workspace;
  double stiffness = 0;                 ///< of the surface, N/m in the world; of all hands the same
  std::size_t steps = 0;                ///< that its trajectory takes
  std::optional<double> duration = {};  ///< s, of a device that never ends by itself
  std::optional<Placement> plan = {};   ///< of the built-in exploration, if it is that
  std::shared_ptr<const SampledTool> tool = {};  ///< that it holds; null: a point
  std::string held = {};  ///< how, along its trajectory; empty: as qx, qy, qz, qw say
};

/// All that a run is made of: what is touched, who touches, and by which clock.
struct Run {
  const TimePlan& time;
  const PagePlan& page;
  const RosPlan& ros;
  LoadedScene& loaded;
  std::vector<Hand>& hands;
  FieldOptions field;
  ProxyOptions proxy;
  Recorder* recorder = nullptr;  ///< who can write all of it down; null: no page, and no --record
  Opening* opening = nullptr;    ///< takes a file for the run after this one; null: none follows
};

/// What the servo of the next of the hands is made with; `steps`: who takes its steps, if anybody.
[[nodiscard]] ServoOptions servo_options(const Run& run, const Hand& hand,
                                         ServoState::Queue* steps = nullptr);

/// Is handed every step of every hand, by its index, as soon as it is done.
using EachStep = std::function<void(std::size_t hand, const ServoState&)>;

/// Reads the trajectory of `motion`, and notes in it how tools are held along it; empty: none is
/// named, or no device follows one.
/// @throws Error as reading does, and when a position is farther from the origin than surfaces can
/// be felt; UsageError when it lasts longer than a day and is to be simulated.
[[nodiscard]] Trajectory trajectory_of(MotionPlan& motion, const std::vector<DevicePlan>& devices);

/// A hand for each of `devices`. Those of other programs and those that hold hardware have their
/// device: it is opened before anything is read. `clock` is the run's and outlives them; null:
/// simulated time. Prints on standard error where devices listen, and what was opened.
/// @throws Error when a socket or hardware cannot be had.
[[nodiscard]] std::vector<Hand> open_hands(const std::vector<DevicePlan>& devices,
                                           const MotionPlan& motion, const TimePlan& time,
                                           WaitingClock* clock);

/// How hands are to move, on what, whether a page may take their tools, and what these are.
struct HandTask {
  const MotionPlan& motion;
  const SurfacePlan& surface;
  const PagePlan& page;
  const NamedTool* tool = nullptr;  ///< null: points
};

/// Puts the hands into what `scene` shows. Those that no person or program leads get their device
/// and go along `trajectory` or, where that is empty, explore.
/// @throws Error when there is nothing to explore.
void place_hands(std::vector<Hand>& hands, const HandTask& task, const Trajectory& trajectory,
                 const Scene& scene);

/// Turns and moves `workspace`, whose axes are the world's, as `placement` wants it. Its frame is
/// the name of a source in `scene`.
void place(Workspace& workspace, const PlacementOptions& placement, const Scene& scene);

/// Makes the frames of `from` part of `to` and notes in `from.feed` what they were like, with their
/// preparation's time as `computing` reports it (s). Both outlive the sink; until its stream has
/// ended the notes are the stream's.
[[nodiscard]] Stream::Sink feeding(LoadedSource& from, Source& to, double (*computing)());

/// The same of the source at `index`, with what keeps its last frame, both recorded by `recorder`
/// unless that is null.
struct Feeding {
  Stream::Sink sink;
  std::function<void()> ended;
};
[[nodiscard]] Feeding feeding(LoadedScene& loaded, std::size_t index, Recorder* recorder);

/// Keeps how the streams and the sources that they fed fared. `states` are in the order of the
/// sources.
void keep_states(LoadedScene& loaded, const std::vector<StreamState>& states);

/// The streams of everything in `loaded` that lives, into its scene; it outlives them.
class LiveFeed {
 public:
  /// Recordings begin together at `start`, s on the clock. `recorder`: may be null.
  LiveFeed(LoadedScene& loaded, const Clock& clock, double start, Recorder* recorder);

  /// How each stream fares, in the order of the sources.
  [[nodiscard]] std::vector<StreamState> states() const;

  /// The share of the clouds' blocks that is prepared, 0-1; the least of all. 1: all is there.
  [[nodiscard]] double prepared() const;

  /// Why parts of clouds are not there, each thing once, in the order in which they were found.
  [[nodiscard]] std::vector<std::string> problems() const;

  /// Ends the streams and puts what they were like into `loaded`, times counted from the start.
  void finish();

 private:
  void prepare(std::size_t index, const std::stop_token& stop);

  LoadedScene& loaded_;
  const Clock& clock_;
  double start_;
  std::vector<Stream> streams_;
  mutable std::mutex mutex_;
  std::vector<std::string> problems_;
  std::vector<std::jthread> preparing_;  // last: they use all of the above
};

}  // namespace palpate::app
