#pragma once

#include "base/description.hpp"
#include "palpate/servo/guard.hpp"
#include "servo/passivity.hpp"

/// Descriptions of the options of guards.
namespace palpate {

template <EitherConst<GuardOptions::Passivity> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [on, mass, memory, forget, delay] = options;
  take(About{"on", "", {}, "", recordings}, on);
  take(About{"mass", "kg", kPositive, "", recordings}, mass);
  take(About{"memory", "J", kNotNegative, "", recordings}, memory);
  take(About{"forget", "s", positive_or("a memory that stays"), "", recordings}, forget);
  take(About{"delay",
             "",
             {.least = 0, .most = Passivity::kMaximumDelay, .words = "0 to 16 steps"},
             "",
             recordings},
       delay);
}

template <EitherConst<GuardOptions> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [on, force, slew, damping, silence, start, share, passivity] = options;
  take(About{"on", "", {}, "", recordings}, on);
  take(
      About{
          "maximum_force", "N", positive_or("no limit"),
          "largest force sent to the device, capped at what it can sustain (default: that limit)"},
      force);
  take(About{"slew", "N/s", kPositive,
             "how fast the force may change beyond what the hand's own motion explains", files},
       slew);
  take(About{"damping", "N s/m", kNotNegative,
             "of a damper along the surface's normal, and along the surface as far as the proxy "
             "sticks",
             files},
       damping);
  take(About{"silence", "s", positive_or("no watchdog"), "", recordings}, silence);
  take(About{"soft_start", "s", kNotNegative,
             "in which forces rise after a start, a pause or a silence, while nothing is touched",
             files},
       start);
  take(About{"stiffness_share", "", positive_or("no limit"), "", python}, share);
  take(About{"passivity", "", {}, "", recordings}, passivity);
}

}  // namespace palpate
