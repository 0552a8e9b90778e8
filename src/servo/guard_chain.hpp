// The links of a guard, for hands of any number of axes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "palpate/servo/guard.hpp"
#include "servo/description.hpp"
#include "servo/hand_path.hpp"
#include "servo/passivity.hpp"
#include "servo/sliding_share.hpp"

namespace palpate {

// False for NaN, too.
template <class Vector>
[[nodiscard]] bool sane(const Vector& v) noexcept {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= Guard::kLargest;
}

template <class Input>
[[nodiscard]] Guard::Fault judge(const Input& input) noexcept {
  if (input.fault != Guard::Fault::none) return input.fault;
  if (!sane(input.hip) || !sane(input.velocity)) return Guard::Fault::hand;
  if (!std::isfinite(input.dt) || input.dt < 0) return Guard::Fault::time;
  if (!sane(input.normal) || !sane(input.drift)) return Guard::Fault::force;
  const bool good_stiffness = input.stiffness >= 0 && input.stiffness <= Guard::kLargest;
  if (!sane(input.force) || !good_stiffness) return Guard::Fault::force;
  return Guard::Fault::none;
}

// Energy of a spring stretched to `force`, J.
template <class Vector>
[[nodiscard]] double stored(const Vector& force, double stiffness) noexcept {
  return stiffness > 0 ? force.squaredNorm() / (2 * stiffness) : 0;
}

inline void note(Guard::State& state, GuardNote bit, std::uint64_t& count) noexcept {
  if (has(state.notes, bit)) return;
  state.notes = state.notes | bit;
  ++count;
}

/// Links of a guard, and its state between steps. `Axes` says what forces are: `Axes::Input` is
/// Guard::Input with vectors of as many axes as the hand feels, and `shortened(force)` is what of a
/// force the device can hold; what it can hold comes back bit for bit. Real-time but for
/// construction.
template <class Axes>
class GuardChain {
 public:
  using Input = typename Axes::Input;
  using Vector = decltype(Input::force);

  /// @throws Error when an option is out of its range.
  GuardChain(const GuardOptions& options, const Axes& axes)
      : options_(options), axes_(axes), passivity_(options.passivity) {
    check_described("guard", options);
  }

  /// Guard::pass()
  [[nodiscard]] Vector pass(const Input& input) noexcept;
  void reset() noexcept;

  [[nodiscard]] const Guard::State& state() const noexcept { return state_; }
  [[nodiscard]] const GuardOptions& options() const noexcept { return options_; }

 private:
  /// What the next force depends on besides the last one.
  enum class Phase : std::uint8_t {
    begins,   // nothing: where the hand was is forgotten
    goes_on,  // on the hand's motion
    lets_go,  // the same; after a reset the force fades before the next one begins
  };

  /// Motion of the hand against the surface.
  struct Moved {
    Vector displacement;  // from the reading before the last one to the last one, m
    double time;          // that took, s
    Vector velocity;      // smoothed, m/s
    double damping;       // N s/m; a damper as late as the readings is no stronger than a brake
  };

  void begin(const Input& input) noexcept;
  [[nodiscard]] Vector pass_on(const Input& input) noexcept;
  [[nodiscard]] Moved follow(const Input& input) noexcept;
  [[nodiscard]] double held(const Input& input) const noexcept;
  [[nodiscard]] Vector damp(const Input& input, const Moved& motion) const noexcept;
  [[nodiscard]] Vector start(const Input& input, const Vector& force) noexcept;
  [[nodiscard]] double affordable_gain(const Input& input) const noexcept;
  [[nodiscard]] bool fades_unpaid(const Input& input, const Moved& motion) const noexcept;
  [[nodiscard]] Vector limit_change(const Input& input, const Moved& motion,
                                    const Vector& force) noexcept;
  [[nodiscard]] Vector brake(const Input& input, const Moved& motion, const Vector& force) noexcept;
  [[nodiscard]] Vector limit_length(const Vector& force) noexcept;
  [[nodiscard]] Vector remember(const Input& input, const Moved& motion,
                                const Vector& force) noexcept;
  [[nodiscard]] Vector fail(Guard::Fault fault) noexcept;

  GuardOptions options_;
  Axes axes_;
  PassivityOf<static_cast<int>(Vector::RowsAtCompileTime)> passivity_;
  Guard::State state_;
  Input before_;                      // its force is the one that was let through
  Vector velocity_ = Vector::Zero();  // smoothed, of the step before
  Vector slewed_ = Vector::Zero();    // let through by clamp and slew then
  double stiffness_ = 0;              // that made a force last, N/m
  HandPath<Vector> path_;
  SlidingShare<Input> sliding_;
  double gain_ = 0;  // of the soft start
  Phase phase_ = Phase::begins;
};

template <class Axes>
void GuardChain<Axes>::reset() noexcept {
  const bool acts = phase_ != Phase::begins && !before_.force.isZero(0);
  state_.fault = Guard::Fault::none;
  phase_ = acts ? Phase::lets_go : Phase::begins;
}

template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::pass(const Input& input) noexcept {
  ++state_.counts.steps;
  state_.notes = GuardNote::none;
  if (state_.fault != Guard::Fault::none) return fail(state_.fault);
  if (const Guard::Fault found = judge(input); found != Guard::Fault::none) return fail(found);
  if (!options_.on) return input.felt ? input.force : Vector::Zero();
  if (phase_ == Phase::lets_go && before_.force.isZero(0)) phase_ = Phase::begins;
  if (phase_ != Phase::lets_go) return pass_on(input);
  Input unfelt = input;
  unfelt.felt = false;
  return pass_on(unfelt);
}

template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::pass_on(const Input& input) noexcept {
  if (phase_ == Phase::begins) begin(input);
  const Vector step = input.hip - before_.hip - input.drift * input.dt;
  sliding_.update(before_, input, step);
  if (input.stiffness > 0) stiffness_ = input.stiffness;
  const Moved motion = follow(input);
  if (input.dt > options_.silence) {
    gain_ = 0;
    slewed_.setZero();
    note(state_, GuardNote::silence, state_.counts.silences);
    return remember(input, motion, Vector::Zero());
  }
  if (input.softened && !input.normal.isZero(0)) {
    note(state_, GuardNote::softened, state_.counts.softened);
  }
  const Vector wanted = limit_length(start(input, damp(input, motion)));
  slewed_ = limit_change(input, motion, wanted);
  return remember(input, motion, limit_length(brake(input, motion, slewed_)));
}

template <class Axes>
void GuardChain<Axes>::begin(const Input& input) noexcept {
  before_ = input;
  before_.force.setZero();
  velocity_ = input.velocity - input.drift;
  gain_ = 0;
  slewed_.setZero();
  stiffness_ = 0;
  path_.begin(velocity_);
  sliding_.begin(input);
  passivity_.reset();
  phase_ = Phase::goes_on;
}

template <class Axes>
typename GuardChain<Axes>::Moved GuardChain<Axes>::follow(const Input& input) noexcept {
  path_.step(input, input.hip - before_.hip);
  const auto& way = path_.last();
  if (input.fresh) {
    passivity_.account(before_.force, way.length, held(input), way.time, way.steps);
    state_.energy = passivity_.energy();
  }
  const double damping = way.steps > 1
                             ? std::min(options_.damping, passivity_.strongest(way.time, 0))
                             : options_.damping;
  return {way.length, way.time, velocity_ + Guard::kSmoothing * (path_.velocity() - velocity_),
          damping};
}

// Energy in the spring, or in a force that still fades after the surface has gone: the larger, J.
template <class Axes>
double GuardChain<Axes>::held(const Input& input) const noexcept {
  return std::max(stored(input.force, input.stiffness), stored(slewed_, stiffness_));
}

// Adds the damper; never turns round the component along the normal.
template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::damp(const Input& input,
                                                         const Moved& motion) const noexcept {
  if (!input.felt) return Vector::Zero();
  if (motion.damping == 0 || input.normal.isZero(0)) return input.force;
  const double pressed = std::max(0.0, input.force.dot(input.normal));
  const double damped = -motion.damping * motion.velocity.dot(input.normal);
  const Vector held = (1 - sliding_.share()) * tangential(motion.velocity, input.normal);
  return input.force + std::max(damped, -pressed) * input.normal - motion.damping * held;
}

template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::start(const Input& input,
                                                          const Vector& force) noexcept {
  gain_ = input.felt ? std::max(gain_, std::min(1.0, affordable_gain(input))) : 0;
  if (gain_ == 1) return force;
  if (input.felt && !force.isZero(0)) note(state_, GuardNote::starting, state_.counts.starting);
  return gain_ * force;
}

// Limits the gain so that the spring, which holds more as it rises, holds no more than the hand has
// put in.
template <class Axes>
double GuardChain<Axes>::affordable_gain(const Input& input) const noexcept {
  if (options_.soft_start == 0) return 1;
  const double risen = gain_ + input.dt / options_.soft_start;
  if (input.normal.isZero(0)) return risen;
  const double whole = stored(input.force, input.stiffness);
  const double put_in = -passivity_.energy();
  return put_in < risen * whole ? put_in / whole : risen;
}

// Brakes in contact only: in the air there is nothing to brake against, so the debt waits.
template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::brake(const Input& input, const Moved& motion,
                                                          const Vector& force) noexcept {
  if (!input.felt || input.normal.isZero(0)) return force;
  const Vector brake = passivity_.brake(force, motion.displacement, motion.time, motion.damping);
  if (brake.isZero(0)) return force;
  note(state_, GuardNote::braked, state_.counts.braked);
  return force + brake;
}

// Does a force that fades in the air hold more energy than the hand has put in? Then it falls as
// fast as the hand moves, like the spring that made it.
template <class Axes>
bool GuardChain<Axes>::fades_unpaid(const Input& input, const Moved& motion) const noexcept {
  return options_.passivity.on && input.normal.isZero(0) &&
         stored(slewed_, stiffness_) > -passivity_.committed(motion.displacement);
}

// Takes the larger stiffness of two steps: where a hand leaves a surface, this step's is 0, and the
// last one's explains the change.
template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::limit_change(const Input& input,
                                                                 const Moved& motion,
                                                                 const Vector& force) noexcept {
  const double loose = fades_unpaid(input, motion) ? stiffness_ : 0;
  const double stiffness = std::max({input.stiffness, before_.stiffness, loose});
  const double explained = stiffness * (input.hip - before_.hip).norm() +
                           motion.damping * (motion.velocity - velocity_).norm();
  const double allowed = explained + options_.slew * input.dt;
  const Vector change = force - slewed_;
  const double size = change.norm();
  if (size <= allowed) return force;
  note(state_, GuardNote::slewed, state_.counts.slewed);
  return slewed_ + allowed / size * change;
}

template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::limit_length(const Vector& force) noexcept {
  const Vector shortened = axes_.shortened(force);
  if (shortened != force) note(state_, GuardNote::clamped, state_.counts.clamped);
  return shortened;
}

template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::remember(const Input& input,
                                                             const Moved& motion,
                                                             const Vector& force) noexcept {
  before_ = input;
  sliding_.remember(input);
  velocity_ = motion.velocity;
  before_.force = force;
  return force;
}

// Goes to zero at once: a step of force is the smaller evil.
template <class Axes>
typename GuardChain<Axes>::Vector GuardChain<Axes>::fail(Guard::Fault fault) noexcept {
  if (state_.fault == Guard::Fault::none) ++state_.counts.faults;
  state_.fault = fault;
  state_.notes = GuardNote::fault;
  phase_ = Phase::begins;
  return Vector::Zero();
}

}  // namespace palpate
