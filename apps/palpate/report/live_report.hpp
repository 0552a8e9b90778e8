#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "palpate/servo/guard.hpp"
#include "palpate/servo/histogram.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

/// What a run in real time was like for one hand.
struct LiveReport {
  RealtimeReport realtime;
  double rate = 0;  ///< steps a second that were wanted, Hz
  Durations lateness;
  std::uint64_t skipped = 0;    ///< steps left out because one before them was late
  std::uint64_t unwritten = 0;  ///< steps that came faster than they could be written down
  GuardOptions limits;          ///< of the guard, as they held
  GuardState guard;             ///< at the end
  std::string failure;          ///< of the device, in words; empty: none
};

/// For a person: how well time was kept, what the guard did, what the system granted.
void print_live(const LiveReport& report, std::FILE* stream);

/// The same as data.
[[nodiscard]] nlohmann::ordered_json json_live(const LiveReport& report);

}  // namespace palpate::app
