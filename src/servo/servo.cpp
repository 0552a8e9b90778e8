// Steps one hand through field, proxy and guard.
#include "palpate/servo/servo.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/latest.hpp"
#include "palpate/base/error.hpp"
#include "servo/held_tool.hpp"
#include "servo/servo_inside.hpp"
#include "servo/step_trace.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// Duration of the first step, s, for a device without a stated rate: 1 kHz is usual (judgement).
constexpr double kFirstStep = 1e-3;

double first_step(const DeviceInfo& device) noexcept {
  return device.rate > 0 ? 1 / device.rate : kFirstStep;
}

// A hand that is not finite makes the proxy latch a fault first: that is the one which is reported.
Guard::Fault fault_of(const ServoState& state) noexcept {
  if (state.device == DeviceState::Status::failed) return Guard::Fault::device;
  return has(state.contact.notes, ContactNote::fault) ? Guard::Fault::proxy : Guard::Fault::none;
}

}  // namespace

struct Servo::Inside {
  Inside(Device& its_device, Scene& scene, const ServoOptions& its_options)
      : device(its_device),
        options(options_for(device.info(), its_options)),
        limited(options.proxy, stiffness_limit_of(device.info(), options), device.info().rate),
        guard(in_world(options.guard, options.workspace.scale)),
        requests(options) {
    if (options.tool) {
      tool = std::make_unique<HeldTool>(scene, options, device.info(), limited.limit.told);
    } else {
      limited.field.emplace(scene, options.field, "a field", options.workspace.scale);
    }
  }

  void step(const DeviceState& read, double now) noexcept;
  void apply_pending() noexcept;
  void place_tool(const DeviceState& read) noexcept;
  void touch_with_point() noexcept;
  void touch_with_tool() noexcept;
  [[nodiscard]] Pose pose() const noexcept {
    return {state.hip, state.orientation, options.workspace.scale * state.gripper};
  }
  // The hand's own, whatever the clutch does.
  [[nodiscard]] Pose hand_pose() const noexcept {
    return {hand, options.workspace.orientation_to_world(basis.device.orientation),
            options.workspace.scale * basis.device.gripper};
  }
  [[nodiscard]] bool is_clutched(std::uint32_t buttons) const noexcept;
  [[nodiscard]] Guard::Input felt() noexcept;
  void let_through(const Guard::Input& input) noexcept;

  Device& device;
  ServoOptions options;
  LimitedProxy limited;            // a point
  std::unique_ptr<HeldTool> tool;  // in its place
  Guard guard;
  Clutch clutch;
  Vector3d hand = Vector3d::Zero();  // where it is without the clutch, m, world
  ServoState state;                  // of the stepping thread; the others see what was shown
  StepInput basis;                   // of its last step
  bool received = false;             // the device has had the hand's position
  ShownSteps shown;
  Requests requests;
};

Servo::Servo(Device& device, Scene& scene, const ServoOptions& options)
    : inside_(std::make_unique<Inside>(device, scene, options)) {}

Servo::~Servo() = default;

const ServoState& Servo::tick(double now) noexcept {
  step(device().read(), now);
  write();
  show();
  return inside_->state;
}

const ServoState& Servo::tick() noexcept {
  const DeviceState read = device().read();
  step(read, read.time);
  write();
  show();
  return inside_->state;
}

const ServoState& Servo::step(const DeviceState& device, double now) noexcept {
  inside_->step(device, now);
  return inside_->state;
}

void Servo::Inside::step(const DeviceState& read, double now) noexcept {
  const bool goes_on = state.step > 0 && std::isfinite(state.time);
  state.dt = goes_on || !std::isfinite(now) ? now - state.time : first_step(device.info());
  state.time = now;
  hand = options.workspace.position_to_world(read.position);
  limited.rhythm.take(read, state.dt);
  basis.device = read;
  received = received || read.status != DeviceState::Status::silent;
  if (options.traces != nullptr && options.traces->accepts()) options.traces->prefetch();
  apply_pending();
  place_tool(read);
  if (tool) {
    touch_with_tool();
  } else {
    touch_with_point();
  }
  let_through(felt());
  ++state.step;
}

void Servo::Inside::touch_with_point() noexcept {
  SceneField& field = *limited.field;
  field.update(state.time, state.hip, limited.proxy);
  state.contact = limited.proxy.step(field, state.hip, state.dt);
  state.tool = pose();
  state.tool.position = state.contact.proxy;
  state.field_notes = field.notes();
  if (options.traces != nullptr) basis.found = field.found();
  state.patch_points = field.patch_points();
}

void Servo::Inside::touch_with_tool() noexcept {
  const Pose held = clutch.turned(pose(), state.clutched, tool->pose());
  state.orientation = held.orientation;
  state.contact = tool->step(state.time, held, state.dt);
  state.field_notes = tool->notes();
  if (options.traces != nullptr) basis.found = tool->found();
  state.tool = tool->pose();
  state.wrench = tool->wrench();
}

// The tool rests where the proxy is: nothing is stretched when the clutch is let go.
void Servo::Inside::place_tool(const DeviceState& read) noexcept {
  state.clutched = is_clutched(read.buttons);
  const Vector3d rest = tool ? tool->pose().position : limited.proxy.position();
  state.hip = clutch.tool(hand, state.clutched, rest);
  state.shift = clutch.shift();
  state.velocity = options.workspace.velocity_to_world(read.velocity);
  state.orientation = options.workspace.orientation_to_world(read.orientation);
  state.gripper = read.gripper;
  state.buttons = read.buttons;
  state.device = read.status;
}

// Before the first hand there is no position where the tool could rest.
bool Servo::Inside::is_clutched(std::uint32_t buttons) const noexcept {
  return state.step > 0 && received && options.clutch_button &&
         ((buttons >> *options.clutch_button) & 1u) != 0;
}

void Servo::Inside::apply_pending() noexcept {
  requests.take(state, basis);
  if (basis.reset || !received) {
    clutch = {};
    limited.proxy.reset(hand);
    if (tool) tool->reset(hand_pose());
    guard.reset();
  }
  if (limited.change(basis.contact) && tool) tool->change(limited.proxy.options());
  if (basis.field && tool) tool->change(*basis.field);
  if (basis.field && limited.field) limited.field->change(*basis.field);
}

Guard::Input Servo::Inside::felt() noexcept {
  Guard::Input input;
  input.felt = !state.paused && state.device != DeviceState::Status::silent;
  input.softened = limited.is_softened();
  input.fresh = limited.rhythm.is_fresh();
  input.hip = hand;
  input.velocity = state.velocity;
  input.dt = state.dt;
  if (state.clutched) {
    // Clutched counts as not touching: a hand that leaves while its force fades loses it as it
    // would from a spring.
    input.stiffness = limited.proxy.options().stiffness;
  } else {
    input.force = state.contact.force;
    input.normal = state.contact.normal;
    input.drift = state.contact.drift;
    input.stiffness = state.contact.stiffness;
  }
  basis.added = requests.added.add_to(input.force, state.time);
  input.fault = fault_of(state);
  return input;
}

void Servo::Inside::let_through(const Guard::Input& input) noexcept {
  if (!tool || !tool->is_felt_turning()) {
    state.force = guard.pass(input);
    state.guard = guard.state();
    return;
  }
  const Vector3d turning =
      options.workspace.T_world_device.linear() * basis.device.angular_velocity;
  const Wrench felt = tool->guarded(input, !state.clutched, hand_pose(), turning);
  state.force = felt.force;
  state.torque = felt.torque;
  state.grip = felt.grip;
  state.guard = tool->guard_state();
}

void Servo::show(const ServoState::Timing& timing) noexcept {
  ServoState& state = inside_->state;
  state.timing = timing;
  inside_->shown.show(state);
  if (inside_->options.steps != nullptr) inside_->options.steps->push(state);
  Ring<StepTrace>* const traces = inside_->options.traces;
  if (traces != nullptr && traces->accepts()) traces->push({state, inside_->basis});
}

void ServoTrace::show(const ServoState& state) noexcept {
  ServoState& shown = servo_->inside_->state;
  const std::uint64_t step = shown.step + 1;
  shown = state;
  shown.step = step;
  servo_->show(state.timing);
}

void Servo::write() noexcept {
  const Inside& in = *inside_;
  const Workspace& workspace = in.options.workspace;
  const bool pushes = in.device.info().maximum_force > 0;
  const Vector3d force = pushes ? in.state.force : Vector3d::Zero();
  if (!in.tool || !in.tool->is_felt_turning()) {
    return in.device.write(pushes ? workspace.force_to_device(force) : force);
  }
  in.device.write_wrench(workspace.wrench_to_device({force, in.state.torque, in.state.grip}));
}

Device& Servo::device() const noexcept {
  return inside_->device;
}
const ServoOptions& Servo::options() const noexcept {
  return inside_->options;
}
double Servo::stiffness_limit() const noexcept {
  return inside_->limited.limit.told;
}
ServoState Servo::state() const noexcept {
  return inside_->shown.state.get();
}
StepDurations Servo::durations() const noexcept {
  return {inside_->shown.lateness.look(), inside_->shown.computing.look()};
}
std::vector<Eigen::Vector3f> Servo::forces_since(std::uint64_t& seen) const {
  return inside_->shown.forces.since(seen);
}
ContactSettings Servo::contact() const noexcept {
  return inside_->requests.contact.get();
}
FieldOptions Servo::field() const noexcept {
  return inside_->requests.field.get();
}

void Servo::pause(bool paused) noexcept {
  inside_->requests.paused.store(paused);
}
void Servo::reset() noexcept {
  inside_->requests.reset.store(true);
}

void Servo::set_contact(const ContactSettings& contact) {
  ProxyOptions checked = inside_->options.proxy;
  checked.stiffness = contact.stiffness;
  checked.friction = contact.friction;
  checked.texture = contact.texture;
  static_cast<void>(Proxy(checked));  // throws what is out of range
  const std::lock_guard lock(inside_->requests.mutex);
  inside_->requests.contact.set(contact);
}

void Servo::add_force(const Vector3d& force) {
  if (!force.allFinite()) throw Error("a force from outside is not finite; find out who sent it");
  const std::lock_guard lock(inside_->requests.mutex);
  inside_->requests.added.set(force);
}

void Servo::set_field(const FieldOptions& field) {
  check(field);
  if (inside_->tool) ToolField::check(field);
  const std::lock_guard lock(inside_->requests.mutex);
  inside_->requests.field.set(field);
}

}  // namespace palpate
