#include <fmt/core.h>

#include "palpate/servo/guard.hpp"

namespace palpate {

GuardOptions in_world(GuardOptions at_hand, double scale) noexcept {
  at_hand.damping /= scale;
  at_hand.passivity.mass /= scale;
  at_hand.passivity.memory *= scale;
  return at_hand;
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
  if (has(state.notes, GuardNote::braked)) {
    add("a brake takes back the energy that the hand was given");
  }
  if (has(state.notes, GuardNote::starting)) add("the force comes up softly");
  if (has(state.notes, GuardNote::softened)) {
    add("the surface is softer than was asked for: the device could not hold that");
  }
  return words;
}

}  // namespace palpate
