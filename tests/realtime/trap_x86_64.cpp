// Syscall User Dispatch (Linux 5.11): while a byte of the thread says so, each system call raises
// SIGSYS instead. No privilege is needed, nothing slows down, and code that makes none is not
// touched: this is what lets thousands of steps be watched one by one.
#include <signal.h>
#include <sys/prctl.h>
#include <ucontext.h>

#include "realtime/trap.hpp"
#include "realtime/watch.hpp"

namespace palpate::realtime {
namespace {

// Numbers of <linux/prctl.h>; older headers lack them.
constexpr int kSetSyscallUserDispatch = 59;
constexpr unsigned long kDispatchOn = 1;
constexpr char kAllow = 0;
constexpr char kBlock = 1;
constexpr greg_t kSyscallInstructionBytes = 2;

thread_local volatile char selector = kAllow;
thread_local volatile long recorded = -1;
thread_local bool enabled = false;

// Records the call, opens the gate, and steps back onto the syscall instruction, so that the call
// is made after all and the program goes on as if it were not watched.
void on_trap(int /*signal*/, siginfo_t* info, void* context) {
  recorded = info->si_syscall;
  selector = kAllow;
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP] -= kSyscallInstructionBytes;
}

}  // namespace

bool enable_trap() noexcept {
  if (enabled) return true;
  struct sigaction action = {};
  action.sa_sigaction = on_trap;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  enabled = prctl(kSetSyscallUserDispatch, kDispatchOn, 0UL, 0UL, &selector) == 0;
  return enabled;
}

void arm_trap() noexcept {
  recorded = -1;
  if (enable_trap()) selector = kBlock;
}

long disarm_trap() noexcept {
  selector = kAllow;
  return recorded;
}

bool can_trap_system_calls() noexcept {
  return enable_trap();
}

}  // namespace palpate::realtime
