#pragma once

#include <csignal>

namespace palpate::app {

/// While it lives, Ctrl-C (SIGINT) and SIGTERM ask the program to come to an end instead of ending
/// it. Once: the second one ends it. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] bool asked() const noexcept;

 private:
  struct sigaction interrupt_before_ = {};
  struct sigaction terminate_before_ = {};
};

}  // namespace palpate::app
