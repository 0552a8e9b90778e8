// Passes a force through watchdog, damper, soft start, slew limit, brake and clamp.
#include "palpate/servo/guard.hpp"

#include <algorithm>
#include <cmath>

#include "servo/description.hpp"
#include "servo/passivity.hpp"
#include "servo/sliding_share.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// False for NaN, too.
bool sane(const Vector3d& v) noexcept {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= Guard::kLargest;
}

Guard::Fault judge(const Guard::Input& input) noexcept {
  if (input.fault != Guard::Fault::none) return input.fault;
  if (!sane(input.hip) || !sane(input.velocity)) return Guard::Fault::hand;
  if (!std::isfinite(input.dt) || input.dt < 0) return Guard::Fault::time;
  if (!sane(input.normal) || !sane(input.drift)) return Guard::Fault::force;
  const bool good_stiffness = input.stiffness >= 0 && input.stiffness <= Guard::kLargest;
  if (!sane(input.force) || !good_stiffness) return Guard::Fault::force;
  return Guard::Fault::none;
}

// Energy of a spring stretched to `force`, J.
double stored(const Vector3d& force, double stiffness) noexcept {
  return stiffness > 0 ? force.squaredNorm() / (2 * stiffness) : 0;
}

void note(Guard::State& state, GuardNote bit, std::uint64_t& count) noexcept {
  if (has(state.notes, bit)) return;
  state.notes = state.notes | bit;
  ++count;
}

}  // namespace

/// Links of a guard, and its state between steps.
class Guard::Inside {
 public:
  explicit Inside(const GuardOptions& options) : options_(options), passivity_(options.passivity) {
    check_described("guard", options);
  }

  [[nodiscard]] Vector3d pass(const Guard::Input& input) noexcept;
  void reset() noexcept;

  [[nodiscard]] const Guard::State& state() const noexcept { return state_; }
  [[nodiscard]] const GuardOptions& options() const noexcept { return options_; }

 private:
  /// Motion of the hand against the surface since the step before.
  struct Motion {
    Vector3d displacement;  // m
    Vector3d velocity;      // smoothed, m/s
  };

  void begin(const Guard::Input& input) noexcept;
  [[nodiscard]] Motion follow(const Guard::Input& input) const noexcept;
  [[nodiscard]] double held(const Guard::Input& input) const noexcept;
  [[nodiscard]] Vector3d damp(const Guard::Input& input, const Motion& motion) const noexcept;
  [[nodiscard]] Vector3d start(const Guard::Input& input, const Vector3d& force) noexcept;
  [[nodiscard]] double affordable_gain(const Guard::Input& input) const noexcept;
  [[nodiscard]] bool fades_unpaid(const Guard::Input& input, const Motion& motion) const noexcept;
  [[nodiscard]] Vector3d limit_change(const Guard::Input& input, const Motion& motion,
                                      const Vector3d& force) noexcept;
  [[nodiscard]] Vector3d brake(const Guard::Input& input, const Motion& motion,
                               const Vector3d& force) noexcept;
  [[nodiscard]] Vector3d limit_length(const Vector3d& force) noexcept;
  [[nodiscard]] Vector3d remember(const Guard::Input& input, const Motion& motion,
                                  const Vector3d& force) noexcept;
  [[nodiscard]] Vector3d fail(Guard::Fault fault) noexcept;

  GuardOptions options_;
  Passivity passivity_;
  Guard::State state_;
  Guard::Input before_;                   // its force is the one that was let through
  Vector3d velocity_ = Vector3d::Zero();  // smoothed, of the step before
  Vector3d slewed_ = Vector3d::Zero();    // let through by clamp and slew then
  double stiffness_ = 0;                  // that made a force last, N/m
  SlidingShare sliding_;
  double gain_ = 0;  // of the soft start
  bool started_ = false;
};

Guard::Guard(const GuardOptions& options) : inside_(std::make_unique<Inside>(options)) {}
Guard::~Guard() = default;
Guard::Guard(Guard&&) noexcept = default;
Guard& Guard::operator=(Guard&&) noexcept = default;

Vector3d Guard::pass(const Guard::Input& input) noexcept {
  return inside_->pass(input);
}

void Guard::reset() noexcept {
  inside_->reset();
}

const Guard::State& Guard::state() const noexcept {
  return inside_->state();
}

const GuardOptions& Guard::options() const noexcept {
  return inside_->options();
}

void Guard::Inside::reset() noexcept {
  state_.fault = Guard::Fault::none;
  started_ = false;
}

Vector3d Guard::Inside::pass(const Guard::Input& input) noexcept {
  ++state_.counts.steps;
  state_.notes = GuardNote::none;
  if (state_.fault != Guard::Fault::none) return fail(state_.fault);
  if (const Guard::Fault found = judge(input); found != Guard::Fault::none) return fail(found);
  if (!options_.on) return input.felt ? input.force : Vector3d::Zero();
  if (!started_) begin(input);
  const Motion motion = follow(input);
  sliding_.update(before_, input, motion.displacement);
  if (input.stiffness > 0) stiffness_ = input.stiffness;
  passivity_.account(before_.force, motion.displacement, held(input), input.dt);
  state_.energy = passivity_.energy();
  if (input.dt > options_.silence) {
    gain_ = 0;
    slewed_.setZero();
    note(state_, GuardNote::silence, state_.counts.silences);
    return remember(input, motion, Vector3d::Zero());
  }
  if (input.softened && !input.normal.isZero(0)) {
    note(state_, GuardNote::softened, state_.counts.softened);
  }
  const Vector3d wanted = limit_length(start(input, damp(input, motion)));
  slewed_ = limit_change(input, motion, wanted);
  return remember(input, motion, limit_length(brake(input, motion, slewed_)));
}

void Guard::Inside::begin(const Guard::Input& input) noexcept {
  before_ = input;
  before_.force.setZero();
  velocity_ = input.velocity - input.drift;
  gain_ = 0;
  slewed_.setZero();
  stiffness_ = 0;
  sliding_.begin(input);
  passivity_.reset();
  started_ = true;
}

Guard::Inside::Motion Guard::Inside::follow(const Guard::Input& input) const noexcept {
  const Vector3d now = input.velocity - input.drift;
  return {input.hip - before_.hip - input.drift * input.dt,
          velocity_ + Guard::kSmoothing * (now - velocity_)};
}

// Energy in the spring, or in a force that still fades after the surface has gone: the larger, J.
double Guard::Inside::held(const Guard::Input& input) const noexcept {
  return std::max(stored(input.force, input.stiffness), stored(slewed_, stiffness_));
}

// Adds the damper; never turns round the component along the normal.
Vector3d Guard::Inside::damp(const Guard::Input& input, const Motion& motion) const noexcept {
  if (!input.felt) return Vector3d::Zero();
  if (options_.damping == 0 || input.normal.isZero(0)) return input.force;
  const double pressed = std::max(0.0, input.force.dot(input.normal));
  const double damped = -options_.damping * motion.velocity.dot(input.normal);
  const Vector3d held = (1 - sliding_.share()) * tangential(motion.velocity, input.normal);
  return input.force + std::max(damped, -pressed) * input.normal - options_.damping * held;
}

Vector3d Guard::Inside::start(const Guard::Input& input, const Vector3d& force) noexcept {
  gain_ = input.felt ? std::max(gain_, std::min(1.0, affordable_gain(input))) : 0;
  if (gain_ == 1) return force;
  if (input.felt && !force.isZero(0)) note(state_, GuardNote::starting, state_.counts.starting);
  return gain_ * force;
}

// Limits the gain so that the spring, which holds more as it rises, holds no more than the hand has
// put in.
double Guard::Inside::affordable_gain(const Guard::Input& input) const noexcept {
  if (options_.soft_start == 0) return 1;
  const double risen = gain_ + input.dt / options_.soft_start;
  if (input.normal.isZero(0)) return risen;
  const double whole = stored(input.force, input.stiffness);
  const double put_in = -passivity_.energy();
  return put_in < risen * whole ? put_in / whole : risen;
}

// Brakes in contact only: in the air there is nothing to brake against, so the debt waits.
Vector3d Guard::Inside::brake(const Guard::Input& input, const Motion& motion,
                              const Vector3d& force) noexcept {
  if (!input.felt || input.normal.isZero(0)) return force;
  const Vector3d brake = passivity_.brake(force, motion.displacement, input.dt, options_.damping);
  if (brake.isZero(0)) return force;
  note(state_, GuardNote::braked, state_.counts.braked);
  return force + brake;
}

// Does a force that fades in the air hold more energy than the hand has put in? Then it falls as
// fast as the hand moves, like the spring that made it.
bool Guard::Inside::fades_unpaid(const Guard::Input& input, const Motion& motion) const noexcept {
  return options_.passivity.on && input.normal.isZero(0) &&
         stored(slewed_, stiffness_) > -passivity_.committed(motion.displacement);
}

// Takes the larger stiffness of two steps: where a hand leaves a surface, this step's is 0, and the
// last one's explains the change.
Vector3d Guard::Inside::limit_change(const Guard::Input& input, const Motion& motion,
                                     const Vector3d& force) noexcept {
  const double loose = fades_unpaid(input, motion) ? stiffness_ : 0;
  const double stiffness = std::max({input.stiffness, before_.stiffness, loose});
  const double explained = stiffness * (input.hip - before_.hip).norm() +
                           options_.damping * (motion.velocity - velocity_).norm();
  const double allowed = explained + options_.slew * input.dt;
  const Vector3d change = force - slewed_;
  const double size = change.norm();
  if (size <= allowed) return force;
  note(state_, GuardNote::slewed, state_.counts.slewed);
  return slewed_ + allowed / size * change;
}

Vector3d Guard::Inside::limit_length(const Vector3d& force) noexcept {
  const double length = force.norm();
  if (length <= options_.maximum_force) return force;
  note(state_, GuardNote::clamped, state_.counts.clamped);
  return options_.maximum_force / length * force;
}

Vector3d Guard::Inside::remember(const Guard::Input& input, const Motion& motion,
                                 const Vector3d& force) noexcept {
  before_ = input;
  sliding_.remember(input);
  velocity_ = motion.velocity;
  before_.force = force;
  return force;
}

// Goes to zero at once: a step of force is the smaller evil.
Vector3d Guard::Inside::fail(Guard::Fault fault) noexcept {
  if (state_.fault == Guard::Fault::none) ++state_.counts.faults;
  state_.fault = fault;
  state_.notes = GuardNote::fault;
  started_ = false;
  return Vector3d::Zero();
}

}  // namespace palpate
