// Integrates a simulated device and the hand that holds it.
#include "palpate/device/simulated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/requirement.hpp"
#include "device/target_motion.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kParts = 16;  // of a step; dry friction's direction is constant in each (judgement)
constexpr int kEvents = 4;  // stops and starts followed in one part (judgement)
constexpr int kBisections = 48;    // of a part, to find when the device stops (judgement)
constexpr double kAtRest = 1e-12;  // m/s; slower counts as at rest (judgement)
constexpr int kMostDelay = 16;     // steps of delay, at most (judgement)

// e^A by Taylor's series of A / 2^n, squared n times: exact to rounding for these small matrices.
Eigen::Matrix4d exponential(const Eigen::Matrix4d& a) {
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.5 ? std::ilogb(norm) + 2 : 0;
  const Eigen::Matrix4d scaled = std::ldexp(1.0, -squarings) * a;
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d sum = term;
  for (int i = 1; i <= 16; ++i) {
    term = Eigen::Matrix4d(term * scaled) / i;
    sum += term;
  }
  for (int i = 0; i < squarings; ++i) sum = Eigen::Matrix4d(sum * sum);
  return sum;
}

SimulatedDeviceOptions checked(const SimulatedDeviceOptions& o) {
  const Requirement require{"simulated device"};
  require.positive("mass", o.mass, "give a positive number of kilograms");
  require.not_negative("damping", o.damping, "give 0 or more N s/m");
  require.not_negative("coulomb", o.coulomb, "give 0 or more newtons");
  require.not_negative("resolution", o.resolution, "give 0 or more metres");
  require(o.delay >= 0 && o.delay <= kMostDelay, "delay", o.delay, "give 0 to 16 steps");
  require.positive("rate", o.rate, "give a positive number of steps per second");
  require.positive("maximum_force", o.maximum_force, "give a positive force in newtons");
  require.not_negative("hand.stiffness", o.hand.stiffness, "give 0 or more N/m");
  require.not_negative("hand.damping", o.hand.damping, "give 0 or more N s/m");
  require.positive("hand.maximum_force", o.hand.maximum_force, "give a positive force in newtons");
  const double duration = o.duration.value_or(0);
  require.not_negative("duration", duration, "give 0 or more seconds");
  require(o.position.allFinite(), "position", o.position.norm(), "give finite coordinates");
  require(o.velocity.allFinite(), "velocity", o.velocity.norm(), "give a finite velocity");
  return o;
}

DeviceInfo info_of(const SimulatedDeviceOptions& options) {
  DeviceInfo info;
  info.name = "simulated";
  info.maximum_force = options.maximum_force;
  info.damping = options.damping;
  info.mass = options.mass;
  info.rate = options.rate;
  info.delay = options.delay / options.rate;
  info.workspace_radius = options.workspace_radius;
  info.keeps_time = true;
  return info;
}

// Matrix A of d/dt (x, v, push, push rate) = A (x, v, push, push rate).
Eigen::Matrix4d generator_of(const SimulatedDeviceOptions& options) {
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator(0, 1) = 1;
  generator(1, 0) = -options.hand.stiffness / options.mass;
  generator(1, 1) = -(options.damping + options.hand.damping) / options.mass;
  generator(1, 2) = 1 / options.mass;
  generator(2, 3) = 1;
  return generator;
}

}  // namespace

// A mass on the hand's spring and damper, with dry friction. Moves exactly between stops and
// starts.
struct HeldMass {
  explicit HeldMass(const SimulatedDeviceOptions& the_options)
      : options(the_options),
        generator(generator_of(options)),
        whole_step(exponential(generator / options.rate)),
        part_step(exponential(generator / (options.rate * kParts))),
        position(options.position),
        velocity(options.velocity) {}

  void advance(const Vector3d& push, const Vector3d& push_rate) noexcept;
  void slide(double duration, Vector3d push, const Vector3d& push_rate) noexcept;
  void flow(const Eigen::Matrix4d& transition, const Vector3d& push,
            const Vector3d& push_rate) noexcept;

  const SimulatedDeviceOptions& options;
  Eigen::Matrix4d generator;
  Eigen::Matrix4d whole_step;  // its exponential over one step
  Eigen::Matrix4d part_step;   // ... and over 1/16 of one
  Vector3d position;
  Vector3d velocity;
};

struct SimulatedDevice::Inside {
  Inside(const SimulatedDeviceOptions& the_options, Trajectory rows)
      : options(checked(the_options)), info(info_of(options)), mass(options) {
    if (!rows.empty()) check(rows);
    trajectory = Playback(std::move(rows));
    if (!options.duration && !trajectory.empty()) options.duration = trajectory.end();
    if (!trajectory.empty()) mass.position = trajectory.front().position;
    forces.fill(Vector3d::Zero());
  }

  [[nodiscard]] TargetSource::Target target_at(double time) noexcept;
  [[nodiscard]] Vector3d quantised() const noexcept {
    if (options.resolution == 0) return mass.position;
    return (mass.position / options.resolution).array().round().matrix() * options.resolution;
  }
  [[nodiscard]] bool fetch(double time) noexcept;
  void advance() noexcept;
  void fail(const char* what) noexcept;

  SimulatedDeviceOptions options;
  Playback trajectory;
  TargetSource* source = nullptr;
  TargetSource::Target target;  // at the current time
  DeviceInfo info;
  HeldMass mass;
  std::array<Vector3d, kMostDelay + 1> forces;  // ring of written forces
  double work = 0;
  std::uint64_t steps = 0;
  DeviceState state;
  bool started = false;
  const char* wrong = nullptr;  // once the device has failed
};

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, Trajectory target)
    : inside_(std::make_unique<Inside>(options, std::move(target))) {}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, TargetSource& source)
    : SimulatedDevice(options) {
  inside_->source = &source;
}

SimulatedDevice::~SimulatedDevice() = default;

const DeviceInfo& SimulatedDevice::info() const noexcept {
  return inside_->info;
}

const Vector3d& SimulatedDevice::true_position() const noexcept {
  return inside_->mass.position;
}

const Vector3d& SimulatedDevice::true_velocity() const noexcept {
  return inside_->mass.velocity;
}

double SimulatedDevice::work() const noexcept {
  return inside_->work;
}

DeviceState SimulatedDevice::read() noexcept {
  Inside& in = *inside_;
  if (in.wrong != nullptr || in.state.status == DeviceState::Status::finished) return in.state;
  if (in.started) {
    in.advance();
  } else if (in.fetch(0) && in.source != nullptr) {
    in.mass.position = in.target.position;
  }
  if (in.wrong != nullptr) return in.state;
  const Vector3d shown = in.quantised();
  if (in.started) in.state.velocity = (shown - in.state.position) * in.options.rate;
  in.state.position = shown;
  in.state.buttons = in.target.buttons;
  in.state.time = static_cast<double>(in.steps) / in.options.rate;
  in.started = true;
  // Half a step of slack: the end of a trajectory need not be a whole number of steps.
  if (in.options.duration && in.state.time > *in.options.duration + 0.5 / in.options.rate) {
    in.state.status = DeviceState::Status::finished;
  }
  return in.state;
}

void SimulatedDevice::write(const Vector3d& force) noexcept {
  Inside& in = *inside_;
  if (in.wrong != nullptr) return;
  if (!force.allFinite()) {
    in.fail("the force written was not finite");
    return;
  }
  const double length = force.norm();
  const double shorten = length > in.options.maximum_force ? in.options.maximum_force / length : 1;
  in.forces[in.steps % in.forces.size()] = shorten * force;
}

std::string SimulatedDevice::reason() const {
  const Inside& in = *inside_;
  if (in.wrong == nullptr) return {};
  return fmt::format("{} at t = {} s; mend the code that computed it", in.wrong, in.state.time);
}

void SimulatedDevice::Inside::fail(const char* what) noexcept {
  wrong = what;
  state.status = DeviceState::Status::failed;
}

TargetSource::Target SimulatedDevice::Inside::target_at(double time) noexcept {
  if (source != nullptr) return source->target(time, mass.position);
  if (trajectory.empty()) return {options.position};
  return {trajectory.at(time)};
}

// Fetches the target at `time`; false if it is not valid.
bool SimulatedDevice::Inside::fetch(double time) noexcept {
  target = target_at(time);
  if (!target.position.allFinite()) fail("the target of the hand was not finite");
  if (!(target.maximum_force > 0)) fail("the largest force of the hand was not above 0");
  return wrong == nullptr;
}

void SimulatedDevice::Inside::advance() noexcept {
  const TargetSource::Target from = target;
  if (!fetch(static_cast<double>(steps + 1) / options.rate)) return;
  const auto delay = static_cast<std::size_t>(options.delay);
  const Vector3d held = forces[(steps + forces.size() - delay) % forces.size()];
  const Vector3d goal_rate = (target.position - from.position) * options.rate;
  const Vector3d drive = options.hand.damping * goal_rate;
  Vector3d push = held + options.hand.stiffness * from.position + drive;
  Vector3d push_rate = options.hand.stiffness * goal_rate;
  // The hand's own damper only brakes; the limit applies to the rest, its pull.
  const double most =
      std::min({options.hand.maximum_force, from.maximum_force, target.maximum_force});
  const Vector3d pull = options.hand.stiffness * (from.position - mass.position) + drive;
  if (pull.norm() > most) {
    push = held + options.hand.stiffness * mass.position + most * pull.normalized();
    push_rate.setZero();
  }
  const Vector3d before = mass.position;
  mass.advance(push, push_rate);
  work += held.dot(mass.position - before);
  // A step without a write() repeats the force before it.
  forces[(steps + 1) % forces.size()] = forces[steps % forces.size()];
  ++steps;
}

// Advances one step; `push` is at its beginning.
void HeldMass::advance(const Vector3d& push, const Vector3d& push_rate) noexcept {
  if (options.coulomb == 0) return flow(whole_step, push, push_rate);
  const double part = 1 / (options.rate * kParts);
  for (int i = 0; i < kParts; ++i) slide(part, push + i * part * push_rate, push_rate);
}

// Advances one part of a step. The device may stop in it, and start again.
void HeldMass::slide(double duration, Vector3d push, const Vector3d& push_rate) noexcept {
  const double whole = duration;
  for (int event = 0; event < kEvents && duration > 0; ++event) {
    Vector3d direction = velocity;
    if (velocity.norm() <= kAtRest) {
      velocity.setZero();
      direction = push - options.hand.stiffness * position;
      if (direction.norm() <= options.coulomb) return;  // held by dry friction
    }
    direction.normalize();
    const Vector3d sliding_push = push - options.coulomb * direction;
    const Vector3d x = position;
    const Vector3d v = velocity;
    flow(duration == whole ? part_step : exponential(generator * duration), sliding_push,
         push_rate);
    if (velocity.dot(direction) > 0) return;
    double moving = 0;
    double stopped = duration;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (moving + stopped);
      position = x;
      velocity = v;
      flow(exponential(generator * middle), sliding_push, push_rate);
      (velocity.dot(direction) > 0 ? moving : stopped) = middle;
    }
    velocity -= direction.dot(velocity) * direction;
    push += stopped * push_rate;
    duration -= stopped;
  }
}

void HeldMass::flow(const Eigen::Matrix4d& transition, const Vector3d& push,
                    const Vector3d& push_rate) noexcept {
  const Vector3d x = transition(0, 0) * position + transition(0, 1) * velocity +
                     transition(0, 2) * push + transition(0, 3) * push_rate;
  velocity = transition(1, 0) * position + transition(1, 1) * velocity + transition(1, 2) * push +
             transition(1, 3) * push_rate;
  position = x;
}

}  // namespace palpate
