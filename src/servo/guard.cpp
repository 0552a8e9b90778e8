#include "palpate/servo/guard.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

void require(bool good, const char* name, double value, const char* range) {
  if (!good) throw Error(fmt::format("guard: {} is {}; give {}", name, value, range));
}

void validate(const GuardOptions& options) {
  require(options.maximum_force > 0, "maximum_force (N)", options.maximum_force,
          "a force above 0, infinity for no limit");
  require(std::isfinite(options.slew) && options.slew > 0, "slew (N/s)", options.slew,
          "a rate above 0");
  require(std::isfinite(options.damping) && options.damping >= 0, "damping (N s/m)",
          options.damping, "a number that is 0 or more");
  require(options.silence > 0, "silence (s)", options.silence,
          "a time above 0, infinity for no watchdog");
}

// False for what is not a number, too.
bool sane(const Vector3d& v) noexcept {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= Guard::kLargest;
}

GuardFault judge(const GuardInput& input) noexcept {
  if (input.fault != GuardFault::none) return input.fault;
  if (!sane(input.hip) || !sane(input.velocity)) return GuardFault::hand;
  if (!std::isfinite(input.dt) || input.dt < 0) return GuardFault::time;
  const bool good_stiffness = input.stiffness >= 0 && input.stiffness <= Guard::kLargest;
  if (!sane(input.force) || !good_stiffness) return GuardFault::force;
  return GuardFault::none;
}

}  // namespace

Guard::Guard(const GuardOptions& options) : options_(options) {
  validate(options);
}

void Guard::reset() noexcept {
  state_.fault = GuardFault::none;
  started_ = false;
}

Vector3d Guard::pass(const GuardInput& input) noexcept {
  ++state_.counts.steps;
  state_.notes = GuardNote::none;
  if (state_.fault != GuardFault::none) return fail(state_.fault);
  if (const GuardFault found = judge(input); found != GuardFault::none) return fail(found);
  if (!started_) {
    before_ = input;
    before_.force.setZero();
    started_ = true;
  }
  if (input.dt > options_.silence) {
    note(GuardNote::silence, state_.counts.silences);
    return remember(input, Vector3d::Zero());
  }
  return remember(input, limit_length(limit_change(input, input.force)));
}

// Leaving a surface, K of this step is 0 and the change is explained by that of the last one.
Vector3d Guard::limit_change(const GuardInput& input, const Vector3d& force) noexcept {
  const double stiffness = std::max(input.stiffness, before_.stiffness);
  const double explained = stiffness * (input.hip - before_.hip).norm() +
                           options_.damping * (input.velocity - before_.velocity).norm();
  const double allowed = explained + options_.slew * input.dt;
  const Vector3d change = force - before_.force;
  const double size = change.norm();
  if (size <= allowed) return force;
  note(GuardNote::slewed, state_.counts.slewed);
  return before_.force + allowed / size * change;
}

Vector3d Guard::limit_length(const Vector3d& force) noexcept {
  const double length = force.norm();
  if (length <= options_.maximum_force) return force;
  note(GuardNote::clamped, state_.counts.clamped);
  return options_.maximum_force / length * force;
}

Vector3d Guard::remember(const GuardInput& input, const Vector3d& force) noexcept {
  before_ = input;
  before_.force = force;
  return force;
}

// At once: a step of force is the smaller evil.
Vector3d Guard::fail(GuardFault fault) noexcept {
  if (state_.fault == GuardFault::none) ++state_.counts.faults;
  state_.fault = fault;
  state_.notes = GuardNote::fault;
  started_ = false;
  return Vector3d::Zero();
}

void Guard::note(GuardNote bit, std::uint64_t& count) noexcept {
  state_.notes = state_.notes | bit;
  ++count;
}

std::string_view in_words(GuardFault fault) noexcept {
  switch (fault) {
    case GuardFault::none:
      return {};
    case GuardFault::force:
      return "the force that was computed is not finite; report it with what was touched";
    case GuardFault::hand:
      return "the device told a place or a velocity that is not finite; look at the device";
    case GuardFault::time:
      return "time did not go on: it was not finite, or went back; look at the clock";
    case GuardFault::proxy:
      return "the proxy was given a place or a time that is not finite; look at the device";
    case GuardFault::device:
      return "the device has failed; it says why, and has to be opened again";
  }
  return {};
}

std::string in_words(const GuardState& state) {
  if (state.fault != GuardFault::none) {
    return fmt::format("zero force until reset: {}", in_words(state.fault));
  }
  std::string words;
  const auto add = [&words](std::string_view text) {
    words += words.empty() ? "" : "; ";
    words += text;
  };
  if (has(state.notes, GuardNote::silence)) {
    add("zero force: the servo was silent for too long; the force comes back softly");
  }
  if (has(state.notes, GuardNote::slewed)) {
    add("the force follows slowly: it changed by more than the hand explains");
  }
  if (has(state.notes, GuardNote::clamped)) {
    add("the force is shortened to the device's maximum");
  }
  return words;
}

}  // namespace palpate
