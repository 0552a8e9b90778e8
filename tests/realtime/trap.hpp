#pragma once

namespace palpate::realtime {

/// Can system calls of the calling thread be trapped here? Installs what is needed for it.
[[nodiscard]] bool enable_trap() noexcept;

/// From now on the first system call of this thread is recorded (and still made).
void arm_trap() noexcept;

/// Ends that. The number of the recorded system call, -1 when there was none.
long disarm_trap() noexcept;

}  // namespace palpate::realtime
