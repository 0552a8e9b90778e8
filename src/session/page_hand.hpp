// What holds for a simulated hand that a page may take.
#pragma once

#include "palpate/servo/servo.hpp"

namespace palpate::session {

inline constexpr double kReachingSpeed = 2;  ///< m/s, a fast reach of an arm; judgement
inline constexpr double kRiseTime =
    0.3;  ///< s; shorter than a press with a mouse lasts (judgement)

/// Nobody can be thrown by a page, and a hand that rests in contact would pay for no more force.
inline void set_for_pages(ServoOptions& options) {
  options.guard.soft_start = 0;
  options.proxy.rise_time = kRiseTime;
}

}  // namespace palpate::session
