// Builds the hands of a run and connects them with devices, servos and the page.
#include "apps/palpate/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/trajectory.hpp"
#include "session/page_hand.hpp"

namespace palpate::app {
namespace {

// Guard's watchdog for simulated devices, s; judgement: PacedDevice catches up after a late step.
constexpr double kSimulatedSilence = 0.05;

std::string socket_path(const DevicePlan& plan) {
  if (!plan.path.empty()) return plan.path;
  try {
    return default_remote_path();
  } catch (const Error&) {
    throw Error(
        "--device remote: XDG_RUNTIME_DIR is not set, so there is no default socket path; give "
        "one, e.g. --device remote:/tmp/hand");
  }
}

void open_socket(Hand& hand, const MotionPlan& motion, const GuardOptions& guard,
                 const Clock& clock) {
  DeviceProfile profile;
  if (!hand.chosen.profile.empty()) profile = device_profile(hand.chosen.profile);
  RemoteDeviceOptions device = remote_options(profile);
  if (!profile.maximum_force && std::isfinite(guard.maximum_force))
    device.maximum_force = guard.maximum_force / Servo::kForceShare;
  device.path = socket_path(hand.chosen);
  device.rate = motion.rate.value_or(device.rate);
  auto opened = std::make_unique<RemoteDevice>(clock, device);
  hand.socket = opened.get();
  hand.duration = motion.duration;
  hand.device = std::move(opened);
  fmt::print(stderr, "{}: listening on {}\n", hand.name, hand.socket->path());
}

void open_hardware(Hand& hand, const MotionPlan& motion, RealtimeOptions asked,
                   WaitingClock& clock) {
  // The processor of the servo is the servo's alone.
  asked.processor.reset();
  ThreadedDeviceOptions device;
  device.begin = [asked] { (void)make_realtime(asked); };
  hand.device = open_device(hand.chosen.path, clock, device);
  hand.duration = motion.duration;
  const DeviceInfo& info = hand.device->info();
  const std::string late =
      info.delay ? ", a force " + duration(*info.delay) + " after its position" : "";
  fmt::print(stderr, "{}: using {}, {:.0f} Hz{}, at most {:.3g} N\n", hand.name, info.name,
             info.rate, late, info.maximum_force);
}

// m: the motors of a simulated wrist are those of its handle at half of a stylus (SimulatedWrist).
constexpr double kWristLever = 0.03;

// The hand is where `trajectory` says, whatever the force.
void play_back(Hand& hand, Trajectory trajectory) {
  hand.steps = trajectory.size();
  hand.device = std::make_unique<ScriptedDevice>(std::move(trajectory));
}

// The hand is pulled along `target` again and again, unless somebody takes the tool. Who did not
// ask for the page has a run that ends with its trajectory.
void guide(Hand& hand, const HandTask& task, SimulatedDeviceOptions device, Trajectory target) {
  static const RemoteTarget kNobody;
  device.duration = task.motion.duration;
  if (!device.duration && !task.page.wanted) device.duration = target.back().time;
  TeleoperatedHandOptions options{.speed = session::kReachingSpeed};
  if (hand.plan) options.presses = hand.plan->presses;
  if (hand.plan) options.force = hand.plan->force;
  if (task.page.served) hand.remote = std::make_unique<RemoteTarget>();
  hand.guide = std::make_unique<TeleoperatedHand>(hand.remote ? *hand.remote : kNobody,
                                                  std::move(target), options);
  hand.device = std::make_unique<SimulatedDevice>(device, *hand.guide);
}

// The hand is pulled along `target`, whose times begin at 0.
void simulate(Hand& hand, const HandTask& task, Trajectory target) {
  SimulatedDeviceOptions device;
  device.rate = task.motion.rate.value_or(device.rate);
  if (task.tool != nullptr) {
    device.wrist.emplace().maximum_torque = kWristLever * device.maximum_force;
  }
  if (!task.page.served) {
    hand.steps = static_cast<std::size_t>(target.back().time * device.rate) + 2;
  }
  if (task.page.served || hand.plan) return guide(hand, task, device, std::move(target));
  hand.device = std::make_unique<SimulatedDevice>(device, std::move(target));
}

void follow(Hand& hand, const HandTask& task, Trajectory trajectory) {
  hand.held = task.motion.held;
  hand.stiffness = task.surface.stiffness.value_or(kStiffness);
  if (hand.chosen.kind == DeviceKind::scripted) return play_back(hand, std::move(trajectory));
  hand.workspace.scale = hand.chosen.placement.scale.value_or(1);
  const double start = trajectory.front().time;
  // Encoders count from where the hand begins, so that far from the origin nothing is lost.
  hand.workspace.T_world_device.translation() = trajectory.front().position;
  for (TrajectoryRow& row : trajectory) {
    row.time -= start;
    row.position = hand.workspace.position_to_device(row.position);
    if (row.opening) *row.opening /= hand.workspace.scale;
  }
  simulate(hand, task, std::move(trajectory));
}

void explore(Hand& hand, const HandTask& task, const Scene& scene, ExplorationOptions plan) {
  const bool pulled = hand.chosen.kind == DeviceKind::simulated;
  if (!pulled) plan.hand.stiffness = std::numeric_limits<double>::infinity();
  Progress progress("planning the exploration");
  plan.progress = progress.updater();
  hand.plan = plan_exploration(scene, task.surface.field, plan);
  hand.workspace = hand.plan->workspace;
  hand.stiffness = hand.plan->stiffness;
  if (pulled) {
    simulate(hand, task, hand.plan->target);
  } else {
    play_back(hand, hand.plan->target);
  }
}

// A device's x goes to the right, y away and z up; a picture's to the right, down and away.
Eigen::Matrix3d behind(const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Matrix3d picture = T_world_camera.linear();
  Eigen::Matrix3d axes;
  axes << picture.col(0), picture.col(2), -picture.col(1);
  return axes;
}

void put_at_surface(Hand& hand, const FieldOptions& field, const Scene& scene,
                    const ExplorationOptions& plan) {
  const Placement placement = place_device(scene, field, plan);
  hand.workspace = placement.workspace;
  hand.stiffness = placement.stiffness;
  place(hand.workspace, hand.chosen.placement, scene);
}

ExplorationOptions plan_options(const HandTask& task, const Trajectory& trajectory,
                                const std::shared_ptr<const SampledTool>& tool) {
  ExplorationOptions plan;
  plan.duration = task.motion.duration.value_or(plan.duration);
  plan.stiffness = task.surface.stiffness.value_or(trajectory.empty() ? 0 : kStiffness);
  plan.tool_radius = task.surface.field.tool_radius;
  plan.seed = task.motion.seed;
  plan.rate = task.motion.rate.value_or(plan.rate);
  if (tool) plan.tool = tool->balls();
  return plan;
}

}  // namespace

ServoOptions servo_options(const Run& run, const Hand& hand, ServoState::Queue* steps) {
  ServoOptions options;
  options.field = run.field;
  options.proxy = run.proxy;
  options.guard = run.time.guard;
  const bool usual = !run.time.own_watchdog;
  if (usual && hand.device->info().keeps_time) options.guard.silence = kSimulatedSilence;
  if (usual && hand.remote) options.guard.silence = std::numeric_limits<double>::infinity();
  if (hand.remote) session::set_for_pages(options);
  options.workspace = hand.workspace;
  options.clutch_button = hand.chosen.placement.clutch;
  options.steps = steps;
  if (hand.tool) {
    options.tool = hand.tool->tool;
    options.gyration = hand.tool->gyration(options.proxy.stiffness);
  }
  options.traces = run.recorder != nullptr ? run.recorder->add_hand() : nullptr;
  return options;
}

std::vector<Hand> open_hands(const std::vector<DevicePlan>& devices, const MotionPlan& motion,
                             const TimePlan& time, WaitingClock* clock) {
  std::vector<Hand> hands;
  for (const DevicePlan& device : devices) {
    Hand& hand = hands.emplace_back();
    hand.name = fmt::format("hand {}", hands.size());
    hand.chosen = device;
    if (device.kind == DeviceKind::remote) open_socket(hand, motion, time.guard, *clock);
    if (device.kind == DeviceKind::hardware) open_hardware(hand, motion, time.realtime, *clock);
  }
  return hands;
}

void place_hands(std::vector<Hand>& hands, const HandTask& task, const Trajectory& trajectory,
                 const Scene& scene) {
  std::shared_ptr<const SampledTool> tool;
  if (task.tool) {
    tool = std::make_shared<const SampledTool>(task.tool->sampled(smallest_radius(scene)));
  }
  ExplorationOptions plan = plan_options(task, trajectory, tool);
  for (Hand& hand : hands) {
    hand.tool = tool;
    plan.scale = hand.chosen.placement.scale;
    if (!hand.chosen.follows_trajectory()) {
      put_at_surface(hand, task.surface.field, scene, plan);
    } else if (trajectory.empty()) {
      explore(hand, task, scene, plan);
    } else {
      follow(hand, task, trajectory);
    }
    ++plan.seed;
  }
}

void place(Workspace& workspace, const PlacementOptions& placement, const Scene& scene) {
  Eigen::Isometry3d& pose = workspace.T_world_device;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    if (!placement.frame.empty() && source.name() == placement.frame) {
      pose.linear() = behind(source.pose());
    }
  }
  pose.translation() += pose.linear() * placement.offset;
}

Stream::Sink feeding(LoadedSource& from, Source& to, double (*computing)()) {
  return [&from, &to, computing](const DepthFrame& frame, const Source::StartTime& start) {
    FeedReport& feed = from.feed;
    feed.width = frame.camera.width;
    feed.height = frame.camera.height;
    const double begin = computing();
    push_frame(from, to, frame, [&] {
      const double felt = start();
      feed.latency_s.push_back(felt - frame.stamp);
      return felt;
    });
    feed.prepare_ms.push_back(1e3 * (computing() - begin));
  };
}

Feeding feeding(LoadedScene& loaded, std::size_t index, Recorder* recorder) {
  Source& to = loaded.scene.source(index);
  Feeding feed{feeding(loaded.sources[index], to, thread_cpu_seconds), [&to] { to.keep(); }};
  if (recorder == nullptr) return feed;
  return {recorder->watching(index, std::move(feed.sink)),
          recorder->watching(index, std::move(feed.ended))};
}

void keep_states(LoadedScene& loaded, const std::vector<StreamState>& states) {
  auto next = states.begin();
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    LoadedSource& source = loaded.sources[i];
    if (!source.camera) continue;
    source.feed.state = *next++;
    source.state = loaded.scene.state(i);
  }
}

}  // namespace palpate::app
