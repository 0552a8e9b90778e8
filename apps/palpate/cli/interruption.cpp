#include "apps/palpate/cli/interruption.hpp"

namespace palpate::app {

namespace {

// A signal is the process's, so is what its handler can reach.
volatile std::sig_atomic_t asked_to_end = 0;

void ask(int) {
  asked_to_end = 1;
}

}  // namespace

Interruption::Interruption() {
  asked_to_end = 0;
  struct sigaction action = {};
  action.sa_handler = ask;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &interrupt_before_);
  sigaction(SIGTERM, &action, &terminate_before_);
}

Interruption::~Interruption() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

bool Interruption::asked() const noexcept {
  return asked_to_end != 0;
}

}  // namespace palpate::app
