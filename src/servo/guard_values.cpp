// Scales guard options to the world and puts a guard's state into words.
#include <fmt/core.h>

#include "palpate/servo/guard.hpp"

namespace palpate {

GuardOptions in_world(GuardOptions at_hand, double scale) noexcept {
  at_hand.damping /= scale;
  at_hand.passivity.mass /= scale;
  at_hand.passivity.memory *= scale;
  return at_hand;
}

std::string_view in_words(Guard::Fault fault) noexcept {
  switch (fault) {
    case Guard::Fault::none:
      return {};
    case Guard::Fault::force:
      return "the computed force is not finite; report this with the cloud that was touched";
    case Guard::Fault::hand:
      return "the device reported a position or velocity that is not finite; check the device";
    case Guard::Fault::time:
      return "the time was not finite or went backwards; check the clock";
    case Guard::Fault::proxy:
      return "the proxy got a position or time that is not finite; check the device";
    case Guard::Fault::device:
      return "the device failed; see its message and reopen it";
  }
  return {};
}

std::string in_words(const Guard::State& state) {
  if (state.fault != Guard::Fault::none) {
    return fmt::format("zero force until reset: {}", in_words(state.fault));
  }
  std::string words;
  const auto add = [&words](std::string_view text) {
    words += words.empty() ? "" : "; ";
    words += text;
  };
  if (has(state.notes, GuardNote::silence)) {
    add("zero force: the servo was late (watchdog); the force ramps up again");
  }
  if (has(state.notes, GuardNote::slewed)) {
    add("slew limit: the force changed faster than the hand's motion explains");
  }
  if (has(state.notes, GuardNote::clamped)) {
    add("the force is limited to the device's maximum");
  }
  if (has(state.notes, GuardNote::braked)) {
    add("braking to dissipate energy given to the hand");
  }
  if (has(state.notes, GuardNote::starting)) add("soft start: the force ramps up");
  if (has(state.notes, GuardNote::softened)) {
    add("the surface is softer than requested: the device cannot render that stiffness");
  }
  return words;
}

}  // namespace palpate
