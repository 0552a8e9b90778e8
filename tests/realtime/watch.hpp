#pragma once

#include <array>
#include <cstddef>
#include <iosfwd>

namespace palpate::realtime {

/// What nothing on the real-time path may do.
enum class Offence { allocate, release, lock, log, raise, clock, system_call };
inline constexpr std::size_t kOffences = 7;

/// What a watched stretch of code did.
struct Findings {
  std::array<int, kOffences> counts{};
  long first_system_call = -1;  ///< its number; -1: none. At most one is counted a watch

  [[nodiscard]] int count(Offence offence) const {
    return counts[static_cast<std::size_t>(offence)];
  }
  [[nodiscard]] int total() const;
};
std::ostream& operator<<(std::ostream& out, const Findings& findings);

/// Watches the calling thread from construction to stop(). Only one watch at a time.
///
/// malloc and its kin, locks, output, throwing and clocks are counted by functions of the same name
/// in this program, which the linker prefers to the C library's. System calls are trapped by the
/// kernel (Syscall User Dispatch), counted, and then let through.
class Watch {
 public:
  Watch() noexcept;
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  Findings stop() noexcept;
};

/// Can this kernel trap system calls? Without that a watch counts the rest only.
[[nodiscard]] bool can_trap_system_calls() noexcept;

/// Called by the interposed functions: counts, if the calling thread is watched.
void note(Offence offence) noexcept;

/// Keeps the optimiser from removing what made `value`.
void keep(const void* value) noexcept;

}  // namespace palpate::realtime
