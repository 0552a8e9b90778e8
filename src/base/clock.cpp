// Reads and waits on CLOCK_MONOTONIC, and reads a thread's CPU time.
#include "palpate/base/clock.hpp"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>

namespace palpate {

double SteadyClock::now() const noexcept {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The steady clock of the C++ library is CLOCK_MONOTONIC.
void SteadyClock::wait_until(double time) noexcept {
  if (!(time > 0)) return;
  const double seconds = std::floor(time);
  std::timespec until{};
  until.tv_sec = static_cast<std::time_t>(seconds);
  until.tv_nsec = static_cast<long>(1e9 * (time - seconds));
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

double thread_cpu_seconds() noexcept {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace palpate
