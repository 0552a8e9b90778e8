// Where the kernel cannot trap system calls by thread: the watch counts the rest only.
#include "realtime/trap.hpp"
#include "realtime/watch.hpp"

namespace palpate::realtime {

bool enable_trap() noexcept {
  return false;
}
void arm_trap() noexcept {}
long disarm_trap() noexcept {
  return -1;
}
bool can_trap_system_calls() noexcept {
  return false;
}

}  // namespace palpate::realtime
