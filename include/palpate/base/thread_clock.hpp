#pragma once

namespace palpate {

/// Computing time that the calling thread has used, s: time in which other threads had the
/// processor does not count. Resolution is the system's, some nanoseconds; one call costs some
/// hundred. A system call: not for the inside of a servo step.
[[nodiscard]] double thread_cpu_seconds() noexcept;

}  // namespace palpate
