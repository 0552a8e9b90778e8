#include "palpate/base/waiting_clock.hpp"

#include <cerrno>
#include <cmath>
#include <ctime>

namespace palpate {

// The steady clock of the C++ library is CLOCK_MONOTONIC.
void SteadyWaitingClock::wait_until(double time) noexcept {
  if (!(time > 0)) return;
  const double seconds = std::floor(time);
  std::timespec until{};
  until.tv_sec = static_cast<std::time_t>(seconds);
  until.tv_nsec = static_cast<long>(1e9 * (time - seconds));
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace palpate
