#include "palpate/servo/servo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/requirement.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kSilencePeriods = 2.5;
constexpr int kButtons = 32;

// Of a device that does not tell its rate: what the first step takes, s.
constexpr double kFirstStep = 1e-3;

ServoOptions options_for(const DeviceInfo& device, ServoOptions options) {
  if (options.clutch_button) {
    Requirement{"servo"}(*options.clutch_button >= 0 && *options.clutch_button < kButtons,
                         "clutch_button", *options.clutch_button, "give a button from 0 to 31");
  }
  options.guard = guard_for(device, options.guard);
  return options;
}

// What the hand may feel, as a stiffness in the world, where motion is magnified.
double stiffness_limit_of(const DeviceInfo& device, const ServoOptions& options) {
  const GuardOptions& guard = options.guard;
  if (!guard.on) return std::numeric_limits<double>::infinity();
  double felt = guard.stiffness_share * passive_stiffness(device, guard.damping);
  if (device.maximum_stiffness > 0) felt = std::min(felt, device.maximum_stiffness);
  return felt / options.workspace.scale;
}

ProxyOptions softened(ProxyOptions proxy, double limit) {
  proxy.stiffness = std::min(proxy.stiffness, limit);
  return proxy;
}

double first_step(const DeviceInfo& device) noexcept {
  return device.rate > 0 ? 1 / device.rate : kFirstStep;
}

/// What was set since it was seen last.
template <class T>
std::optional<T> news(const Latest<T>& wish, std::uint64_t& seen) noexcept {
  const std::uint64_t generation = wish.generation();
  if (generation == seen) return std::nullopt;
  const std::optional<T> found = wish.look();
  if (found) seen = generation;
  return found;
}

GuardFault known_fault(const ServoState& state) noexcept {
  if (state.device == DeviceStatus::failed) return GuardFault::device;
  return has(state.contact.notes, ContactNote::fault) ? GuardFault::proxy : GuardFault::none;
}

}  // namespace

// A device that renders no force is given what would be felt.
GuardOptions guard_for(const DeviceInfo& device, GuardOptions options) {
  if (device.maximum_force > 0) {
    options.maximum_force =
        std::min(options.maximum_force, Servo::kForceShare * device.maximum_force);
  }
  if (device.mass > 0) options.passivity.mass = device.mass;
  if (device.delay) {
    const double steps = std::round(*device.delay * device.rate);
    options.passivity.delay =
        static_cast<int>(std::clamp<double>(steps, 0, Passivity::kMaximumDelay));
  }
  if (device.rate > 0) options.silence = std::max(options.silence, kSilencePeriods / device.rate);
  return options;
}

Servo::Servo(Device& device, Scene& scene, const ServoOptions& options)
    : device_(device),
      options_(options_for(device.info(), options)),
      stiffness_limit_(stiffness_limit_of(device.info(), options_)),
      softened_(options.proxy.stiffness > stiffness_limit_),
      field_(scene, options_.field, "a field", options_.workspace.scale),
      proxy_(softened(options_.proxy, stiffness_limit_)),
      guard_(in_world(options_.guard, options_.workspace.scale)),
      wanted_field_(options_.field) {}

const ServoState& Servo::tick(double now) noexcept {
  step(device_.read(), now);
  device_.write(device_force());
  show();
  return state_;
}

const ServoState& Servo::tick() noexcept {
  const DeviceState device = device_.read();
  step(device, device.time);
  device_.write(device_force());
  show();
  return state_;
}

const ServoState& Servo::step(const DeviceState& device, double now) noexcept {
  const bool goes_on = started_ && std::isfinite(state_.time);
  state_.dt = goes_on ? now - state_.time : first_step(device_.info());
  state_.time = now;
  hand_ = options_.workspace.position_to_world(device.position);
  heard_ = heard_ || device.status != DeviceStatus::silent;
  take_wishes();
  place_tool(device);
  field_.update(now, state_.hip, started_ ? proxy_.position() : state_.hip);
  started_ = true;
  state_.contact = proxy_.step(field_, state_.hip, state_.dt);
  state_.force = guarded();
  state_.guard = guard_.state();
  state_.field_notes = field_.notes();
  state_.patch_points = field_.patch_points();
  ++state_.step;
  return state_;
}

// The tool rests where the proxy is: nothing is stretched when the clutch is let go.
void Servo::place_tool(const DeviceState& device) noexcept {
  const Workspace& workspace = options_.workspace;
  state_.clutched = is_clutched(device.buttons);
  state_.hip = clutch_.tool(hand_, state_.clutched, proxy_.position());
  state_.shift = clutch_.shift();
  state_.velocity = workspace.velocity_to_world(device.velocity);
  state_.orientation = workspace.orientation_to_world(device.orientation);
  state_.gripper = device.gripper;
  state_.buttons = device.buttons;
  state_.device = device.status;
}

// Before the first hand there is no place where the tool could rest.
bool Servo::is_clutched(std::uint32_t buttons) const noexcept {
  return started_ && heard_ && options_.clutch_button &&
         ((buttons >> *options_.clutch_button) & 1u) != 0;
}

void Servo::take_wishes() noexcept {
  state_.paused = paused_.load();
  if (reset_.exchange(false) || !heard_) {
    clutch_ = {};
    proxy_.reset(hand_);
    guard_.reset();
  }
  if (const std::optional<Feel> feel = news(feel_, feel_seen_)) {
    softened_ = feel->stiffness > stiffness_limit_;
    proxy_.change(std::min(feel->stiffness, stiffness_limit_), feel->friction, feel->texture);
  }
  if (const std::optional<FieldOptions> field = news(wanted_field_, field_seen_)) {
    field_.change(*field);
  }
}

Vector3d Servo::guarded() noexcept {
  GuardInput input;
  input.felt = !state_.paused && state_.device != DeviceStatus::silent;
  input.softened = softened_;
  input.hip = hand_;
  input.velocity = state_.velocity;
  input.dt = state_.dt;
  if (state_.clutched) {
    // As in the air. A hand that goes out while its force fades loses it as it would from a spring.
    input.stiffness = proxy_.options().stiffness;
  } else {
    input.force = state_.contact.force;
    input.normal = state_.contact.normal;
    input.drift = state_.contact.drift;
    input.stiffness = state_.contact.stiffness;
  }
  input.fault = known_fault(state_);
  return guard_.pass(input);
}

void Servo::show(const StepTiming& timing) noexcept {
  state_.timing = timing;
  lateness_.add(timing.lateness);
  computing_.add(timing.computing);
  shown_.set(state_);
  recent_forces_.add(state_.force.cast<float>());
  if (options_.steps != nullptr) options_.steps->push(state_);
}

void Servo::set_feel(const Feel& feel) {
  ProxyOptions checked = options_.proxy;
  checked.stiffness = feel.stiffness;
  checked.friction = feel.friction;
  checked.texture = feel.texture;
  static_cast<void>(Proxy(checked));  // throws what is out of range
  const std::lock_guard lock(wish_mutex_);
  feel_.set(feel);
}

void Servo::set_field(const FieldOptions& field) {
  check(field);
  const std::lock_guard lock(wish_mutex_);
  wanted_field_.set(field);
}

}  // namespace palpate
