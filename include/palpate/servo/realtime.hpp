#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// What a servo's thread asks the system for.
struct RealtimeOptions {
  bool realtime_priority = true;      ///< SCHED_FIFO: before everything that is not real-time
  int priority = 80;                  ///< 1-99; above 50 it goes before most drivers' threads
  bool lock_memory = true;            ///< no page of the program is ever fetched from disk
  std::optional<int> processor = {};  ///< pin the thread to this one, from 0
};

/// One thing that was asked for.
struct RealtimeRequest {
  std::string what;  ///< "real-time priority 80 (SCHED_FIFO)"
  bool granted = false;
  std::string remedy;  ///< why it was not granted and how to permit it; empty when it was
};

/// What came of asking; nothing in it is needed for a servo to run, all of it is to run on time.
struct RealtimeReport {
  std::vector<RealtimeRequest> requests;

  [[nodiscard]] bool all_granted() const noexcept;
};

/// A line for each request: what was granted, what was not, why and how to permit it.
[[nodiscard]] std::string in_words(const RealtimeReport& report);

/// Asks for the calling thread; locked memory is the whole process's. Not real-time, never throws
/// for what is refused.
[[nodiscard]] RealtimeReport make_realtime(const RealtimeOptions& options);

/// Leaves a processor to the servo that is pinned there: the calling thread and those that it
/// starts from now on run on the others, and never sweep out the caches of a step. Refused where
/// there is no other.
[[nodiscard]] RealtimeRequest leave_processor(int processor);

}  // namespace palpate
