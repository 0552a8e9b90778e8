#pragma once

#include <semaphore.h>

#include <chrono>

namespace palpate::device {

/// Wakes a thread that waits, from one that may not wait itself.
class Wakeup {
 public:
  Wakeup() noexcept { ::sem_init(&semaphore_, 0, 0); }
  ~Wakeup() { ::sem_destroy(&semaphore_); }
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  /// Wakes whoever waits, or will wait next. Takes no lock. Any thread.
  void post() noexcept { ::sem_post(&semaphore_); }

  /// Waits for a post. False: there was none until `end`, or a signal came.
  bool wait_until(std::chrono::steady_clock::time_point end) noexcept {
    using std::chrono::duration_cast;
    const auto since = end.time_since_epoch();
    const auto seconds = duration_cast<std::chrono::seconds>(since);
    const auto rest = duration_cast<std::chrono::nanoseconds>(since - seconds);
    const timespec time{seconds.count(), rest.count()};
    return ::sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &time) == 0;
  }

 private:
  sem_t semaphore_{};
};

}  // namespace palpate::device
