// Times the steps of prepare().
#pragma once

#include <chrono>

namespace palpate {

/// Adds the time since it was made, or since the last lap, to `seconds`.
class Stopwatch {
 public:
  void lap(double& seconds) {
    const auto now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point last_ = Clock::now();
};

}  // namespace palpate
