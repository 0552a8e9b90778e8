#include "apps/palpate/run/hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/touch_surface.hpp"
#include "apps/palpate/options/touch_usage.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/open_device.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

namespace {

std::string socket_path(const DeviceChoice& choice) {
  if (!choice.path.empty()) return choice.path;
  try {
    return default_remote_path();
  } catch (const Error&) {
    throw Error(
        "--device remote: XDG_RUNTIME_DIR is not set, so there is no usual place for the socket; "
        "give one, as in --device remote:/tmp/hand");
  }
}

void open_socket(Hand& hand, const DeviceChoice& choice, const TouchOptions& options,
                 const Clock& clock) {
  RemoteDeviceOptions device;
  device.path = socket_path(choice);
  device.rate = options.rate.value_or(device.rate);
  if (options.live.maximum_force) {
    device.maximum_force = *options.live.maximum_force / Servo::kForceShare;
  }
  auto opened = std::make_unique<RemoteDevice>(clock, device);
  hand.socket = opened.get();
  hand.duration = options.duration;
  hand.device = std::move(opened);
  fmt::print(stderr, "{}: listens on {}\n", hand.name, hand.socket->path());
}

void open_hardware(Hand& hand, const DeviceChoice& choice, const TouchOptions& options,
                   WaitingClock& clock) {
  // The processor of the servo is the servo's alone.
  RealtimeOptions asked = realtime_options(options.live);
  asked.processor.reset();
  ThreadedDeviceOptions device;
  device.begin = [asked] { (void)make_realtime(asked); };
  hand.device = open_device(choice.path, clock, device);
  hand.duration = options.duration;
  fmt::print(stderr, "{}: holds {}\n", hand.name, hand.device->info().name);
}

// The hand is where `way` says, whatever the force.
void play_back(Hand& hand, Trajectory way) {
  hand.steps = way.size();
  hand.device = std::make_unique<ScriptedDevice>(std::move(way));
}

// The hand is pulled along `target` again and again, unless somebody takes the tool. Who did not
// ask for the page has a run that ends with its way.
void guide(Hand& hand, const TouchOptions& options, SimulatedDeviceOptions device,
           Trajectory target) {
  device.duration = options.duration;
  if (!device.duration && !options.view.wanted) device.duration = target.back().time;
  hand.remote = std::make_unique<RemoteTarget>();
  hand.guide = std::make_unique<TeleoperatedHand>(*hand.remote, std::move(target));
  hand.device = std::make_unique<SimulatedDevice>(device, *hand.guide);
}

// The hand is pulled along `target`, whose times begin at 0.
void simulate(Hand& hand, const TouchOptions& options, Trajectory target) {
  SimulatedDeviceOptions device;
  device.rate = options.rate.value_or(device.rate);
  if (has_page(options)) return guide(hand, options, device, std::move(target));
  hand.steps = static_cast<std::size_t>(target.back().time * device.rate) + 2;
  hand.device = std::make_unique<SimulatedDevice>(device, std::move(target));
}

void follow(Hand& hand, const DeviceChoice& choice, const TouchOptions& options, Trajectory way) {
  hand.stiffness = options.stiffness.value_or(kStiffness);
  if (choice.kind == DeviceKind::scripted) return play_back(hand, std::move(way));
  hand.workspace.scale = choice.stand.scale.value_or(1);
  const double start = way.front().time;
  for (TrajectoryRow& row : way) row.time -= start;
  // Encoders count from where the hand begins, so that far from the origin nothing is lost.
  hand.workspace.T_world_device.translation() = way.front().position;
  for (TrajectoryRow& row : way) row.position = hand.workspace.position_to_device(row.position);
  simulate(hand, options, std::move(way));
}

void explore(Hand& hand, const DeviceChoice& choice, const TouchOptions& options,
             const Scene& scene, const FieldOptions& field, PlanOptions plan) {
  const bool pulled = choice.kind == DeviceKind::simulated;
  if (!pulled) plan.hand.stiffness = std::numeric_limits<double>::infinity();
  Progress progress("planning the exploration");
  plan.progress = [&](double done) { progress.update(done); };
  hand.plan = plan_exploration(scene, field, plan);
  hand.workspace = hand.plan->workspace;
  hand.stiffness = hand.plan->stiffness;
  if (pulled) {
    simulate(hand, options, hand.plan->target);
  } else {
    play_back(hand, hand.plan->target);
  }
}

void stand(Hand& hand, const DeviceChoice& choice, const TouchOptions& options, const Scene& scene,
           const FieldOptions& field, const PlanOptions& plan) {
  const Stand stand = plan_stand(scene, field, plan);
  hand.workspace = stand.workspace;
  hand.stiffness = stand.stiffness;
  hand.clutch = choice.stand.clutch;
  const std::string& frame = choice.stand.frame;
  if (!frame.empty()) hand.camera = camera_named(frame, choose_sources(options));
  apply(choice.stand, hand.camera, scene, hand.workspace);
}

PlanOptions plan_options(const TouchOptions& options, const Trajectory& way) {
  PlanOptions plan;
  plan.duration = options.duration.value_or(plan.duration);
  plan.stiffness = options.stiffness.value_or(way.empty() ? 0 : kStiffness);
  plan.tool_radius = options.tool_radius;
  plan.seed = options.seed.value_or(plan.seed);
  plan.rate = options.rate.value_or(plan.rate);
  return plan;
}

}  // namespace

Trajectory read_way(const TouchOptions& options) {
  const bool led = std::ranges::any_of(choose_devices(options), &DeviceChoice::is_led);
  if (options.trajectory.empty() || !led) return {};
  Trajectory way = read_trajectory(options.trajectory);
  check_trajectory(options, way);
  return way;
}

std::vector<Hand> open_hands(const TouchOptions& options, WaitingClock* clock) {
  std::vector<Hand> hands;
  const std::vector<DeviceChoice> devices = choose_devices(options);
  for (const DeviceChoice& choice : devices) {
    Hand& hand = hands.emplace_back();
    hand.name = fmt::format("hand {}", hands.size());
    hand.led = choice.is_led();
    if (choice.kind == DeviceKind::remote) open_socket(hand, choice, options, *clock);
    if (choice.kind == DeviceKind::hardware) open_hardware(hand, choice, options, *clock);
  }
  return hands;
}

void place_hands(std::vector<Hand>& hands, const TouchOptions& options, const Trajectory& way,
                 const Scene& scene, const FieldOptions& field) {
  const std::vector<DeviceChoice> devices = choose_devices(options);
  PlanOptions plan = plan_options(options, way);
  for (std::size_t i = 0; i < hands.size(); ++i, ++plan.seed) {
    plan.scale = devices[i].stand.scale;
    if (!hands[i].led) {
      stand(hands[i], devices[i], options, scene, field, plan);
    } else if (way.empty()) {
      explore(hands[i], devices[i], options, scene, field, plan);
    } else {
      follow(hands[i], devices[i], options, way);
    }
  }
}

}  // namespace palpate::app
