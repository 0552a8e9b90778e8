// A robot that follows the proxy on what a camera sees: robot_on_camera CAMERA SECONDS SEED. A
// simulated hand explores, and presses, what moves. Prints how many targets a subscriber got, how
// many of them are no proxy of any step, and how deep (mm) the proxies behind them were in the
// surface of their step, as a second field has it; and how deep the hand was.
#include <fmt/format.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "servo/step_trace.hpp"

namespace {

using namespace palpate;
using Eigen::Vector3d;
using Place = std::array<double, 3>;

constexpr double kDeepest = 1e-4;  // m
constexpr double kLatest = 0.02;   // s; of steps before that the surface may be gone

Place place_of(const Vector3d& position) {
  return {position.x(), position.y(), position.z()};
}

// How deep `place` is in the surface that `field` was brought to, m.
double depth_at(const SceneField& field, const Vector3d& place) {
  const Sample at = field.sample(place);
  const double steepness = at.gradient.norm();
  return at.value < 0 && steepness > 0 ? -at.value / steepness : 0;
}

struct Result {
  std::uint64_t targets = 0;
  std::uint64_t strange = 0;
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
  field.update(step.time, step.hip, step.contact.proxy);
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

Result run(Servo& servo, Scene& scene, StepTraces& steps, WaitingClock& clock, double end) {
  const RosBridge bridge({{"hand", &servo}}, scene, {}, {.robot = {{.preset = "crisp"}}});
  const dds::Participant participant(dds::environment_options());
  dds::Reader<message::PoseStamped> targets(participant, "/target_pose",
                                            {.reliable = true, .depth = 100});
  SceneField field(scene, servo.options().field, "the test");
  const ServoThread thread(servo, clock, {}, 1000);
  std::set<Place> places;
  std::vector<Place> taken;
  Result result;
  for (message::PoseStamped told; clock.now() < end;) {
    targets.wait(2e-3);
    while (targets.take(told)) {
      const message::Point& p = told.pose.position;
      taken.push_back({p.x, p.y, p.z});
    }
    while (const std::optional<StepTrace> step = steps.pop()) {
      if (clock.now() - step->state.time < kLatest) check(*step, field, result);
      places.insert(place_of(step->state.contact.proxy));
    }
  }
  result.targets = taken.size();
  for (const Place& place : taken) result.strange += places.contains(place) ? 0 : 1;
  return result;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const double seconds = std::stod(arguments[2]);
  SteadyClock clock;
  Scene scene;
  Source& source = scene.add("camera");
  const auto camera = open_camera(arguments[1], {.clock = &clock});
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
  const Result found = run(servo, scene, steps, clock, clock.now() + seconds);
  if (steps.dropped() > 0) fmt::print("{} steps were left out\n", steps.dropped());
  fmt::print(
      "{} targets, {} of them no proxy; {} steps looked at, {} in contact; proxy at most {:.4f} mm "
      "deep (notes {:x}; {} steps deeper than 0.1), hand {:.2f} mm\n",
      found.targets, found.strange, found.judged, found.touching, 1e3 * found.proxy,
      static_cast<unsigned>(found.notes), found.deep, 1e3 * found.hand);
  const bool followed = static_cast<double>(found.targets) > 50 * seconds && found.judged > 0;
  return followed && found.strange == 0 && found.proxy <= kDeepest ? 0 : 1;
}
