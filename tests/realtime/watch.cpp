#include "realtime/watch.hpp"

#include <numeric>
#include <ostream>
#include <string_view>

#include "realtime/trap.hpp"

namespace palpate::realtime {
namespace {

constexpr std::array<std::string_view, kOffences> kNames = {
    "allocations", "releases", "locks", "outputs", "throws", "clock readings", "system calls"};

// Zero-initialised, so that the very first malloc of a thread may read them.
thread_local bool is_watched = false;
thread_local Findings findings;

}  // namespace

int Findings::total() const {
  return std::accumulate(counts.begin(), counts.end(), 0);
}

std::ostream& operator<<(std::ostream& out, const Findings& found) {
  for (std::size_t i = 0; i < kOffences; ++i) {
    if (found.counts[i] != 0) out << found.counts[i] << ' ' << kNames[i] << "; ";
  }
  if (found.first_system_call >= 0) out << "first system call: " << found.first_system_call;
  return out;
}

Watch::Watch() noexcept {
  findings = {};
  is_watched = true;
  arm_trap();
}

Watch::~Watch() {
  stop();
}

Findings Watch::stop() noexcept {
  const long system_call = disarm_trap();
  is_watched = false;
  Findings found = findings;
  if (system_call >= 0) {
    found.first_system_call = system_call;
    found.counts[static_cast<std::size_t>(Offence::system_call)] = 1;
  }
  findings = {};
  return found;
}

void note(Offence offence) noexcept {
  if (is_watched) ++findings.counts[static_cast<std::size_t>(offence)];
}

void keep(const void* value) noexcept {
  asm volatile("" : : "g"(value) : "memory");
}

}  // namespace palpate::realtime
