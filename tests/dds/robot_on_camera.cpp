// A robot that follows the proxy on what a camera sees: robot_on_camera CAMERA SECONDS SEED. A
// simulated hand explores, and presses, what moves. Prints how many targets a subscriber got, how
// deep (mm) they were in the truth, and how deep (mm) the proxies behind them were in the
// surface of their step, as a second field has it; and how deep the hand was.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "servo/step_trace.hpp"
#include "sim/simulated_camera.hpp"

namespace {

using namespace palpate;
using Eigen::Vector3d;
constexpr double kDeepest = 1e-4;  // m
constexpr double kUntold = 0.01;   // m, of noise, and of what moved before a frame showed it
constexpr double kBusy = 0.1;      // s that a target may be on its way on a busy machine
constexpr double kLatest = 0.02;   // s; of steps before that the surface may be gone

// How deep `place` is in the surface that `field` was brought to, m.
double depth_at(const SceneField& field, const Vector3d& place) {
  const Sample at = field.sample(place);
  const double steepness = at.gradient.norm();
  return at.value < 0 && steepness > 0 ? -at.value / steepness : 0;
}

struct Result {
  std::uint64_t targets = 0;
  double target = 0;  // deepest of them in the truth, m
  std::uint64_t judged = 0;
  std::uint64_t touching = 0;
  std::uint64_t deep = 0;                 // judged, whose proxy was deeper than kDeepest
  ContactNote notes = ContactNote::none;  // of the deepest
  double proxy = 0;
  double hand = 0;
  SceneField::Found found;  // of the step before
  bool same = false;        // was the second field's the same?
  bool together = false;    // have both had the present surfaces from the same step on?
};

// Where the second field has the surfaces that the step had, and from the same step on: a surface
// that comes late catches up from when it was found.
void check(const StepTrace& trace, SceneField& field, Result& result) {
  const ServoState& step = trace.state;
  field.update_from(step.time, step.hip, step.contact.proxy);
  field.begin_step();
  const bool same = field.found().publications == trace.input.found.publications;
  const bool changed = trace.input.found.publications != result.found.publications;
  if (!same || changed) result.together = same && result.same;
  result.found = trace.input.found;
  result.same = same;
  const bool told = !has(step.field_notes, FieldNote::no_surface | FieldNote::behind) &&
                    !has(step.contact.notes, ContactNote::reanchored | ContactNote::not_converged);
  if (result.together && told) {
    ++result.judged;
    const double depth = depth_at(field, step.contact.proxy);
    result.deep += depth > kDeepest ? 1 : 0;
    if (depth > result.proxy) result.notes = step.contact.notes;
    result.proxy = std::max(result.proxy, depth);
    result.hand = std::max(result.hand, depth_at(field, step.hip));
    result.touching += step.contact.touching ? 1 : 0;
  }
  field.end_step(step.contact.proxy, step.contact.normal);
}

// How deep `place` is in what the camera looks at, where that is least deep since `kBusy` ago, m.
double true_depth(const SimulatedCamera& camera, const Vector3d& place, double now) {
  double depth = std::numeric_limits<double>::infinity();
  for (double t = now - kBusy; t <= now; t += kBusy / 4) {
    depth = std::min(depth, -distance_and_normal(camera.scene(), place, t - camera.start()).value);
  }
  return std::max(depth, 0.0);
}

Result run(Servo& servo, Scene& scene, const SimulatedCamera& camera, StepTraces& steps,
           WaitingClock& clock, double end) {
  const RosBridge bridge({{"hand", &servo}}, scene, {}, {.robot = {{.preset = "crisp"}}});
  const dds::Participant participant(dds::environment_options());
  dds::Reader<message::PoseStamped> targets(participant, "/target_pose",
                                            {.reliable = true, .depth = 100});
  SceneField field(scene, servo.options().field, "the test");
  const ServoThread thread(servo, clock, {}, 1000);
  Result result;
  for (message::PoseStamped told; clock.now() < end;) {
    targets.wait(2e-3);
    while (targets.take(told)) {
      const message::Point& p = told.pose.position;
      ++result.targets;
      result.target = std::max(result.target, true_depth(camera, {p.x, p.y, p.z}, clock.now()));
    }
    while (const std::optional<StepTrace> step = steps.pop()) {
      if (clock.now() - step->state.time < kLatest) check(*step, field, result);
    }
  }
  const RosBridge::RobotState robot = bridge.robot().value();
  for (const auto& [reason, time] : robot.waits) fmt::print("{:.1f} s {}\n", time, reason);
  return result;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const double seconds = std::stod(arguments[2]);
  SteadyClock clock;
  Scene scene;
  Source& source = scene.add("camera");
  const auto camera = open_simulated(arguments[1], &clock);
  const Stream stream(*camera, source, clock);
  while (!source.points()) clock.wait_until(clock.now() + 0.01);
  const Placement plan =
      plan_exploration(scene, {}, {.duration = seconds, .seed = std::stoul(arguments[3])});
  SimulatedDevice simulated({}, plan.target);
  PacedDevice device(simulated, clock);
  StepTraces steps(1 << 16);
  ServoOptions options;
  options.workspace = plan.workspace;
  options.proxy.stiffness = plan.stiffness;
  options.traces = &steps;
  Servo servo(device, scene, options);
  const Result found = run(servo, scene, *camera, steps, clock, clock.now() + seconds);
  if (steps.dropped() > 0) fmt::print("{} steps were left out\n", steps.dropped());
  fmt::print(
      "{} targets, at most {:.2f} mm deep; {} steps looked at, {} in contact; proxy at most {:.4f} "
      "mm deep (notes {:x}; {} steps deeper than 0.1), hand {:.2f} mm\n",
      found.targets, 1e3 * found.target, found.judged, found.touching, 1e3 * found.proxy,
      static_cast<unsigned>(found.notes), found.deep, 1e3 * found.hand);
  const bool followed = static_cast<double>(found.targets) > 50 * seconds && found.judged > 0;
  return followed && found.target <= kUntold && found.proxy <= kDeepest ? 0 : 1;
}
