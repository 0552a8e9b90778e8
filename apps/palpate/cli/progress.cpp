#include "apps/palpate/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace palpate::app {

using namespace std::chrono_literals;

Progress::Progress(std::string what)
    : what_(std::move(what)),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + (terminal_ ? 100ms : 2000ms)) {}

Progress::~Progress() {
  if (terminal_ && shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(double done) {
  if (Clock::now() < next_) return;
  next_ = Clock::now() + (terminal_ ? 100ms : 5000ms);
  show(done);
}

void Progress::show(double done) {
  shown_ = true;
  const std::string share = fmt::format(": {:.0f} %", 100 * done);
  if (terminal_) {
    fmt::print(stderr, "\r{}{}\033[K", what_, share);
  } else {
    fmt::print(stderr, "{}{}\n", what_, share);
  }
  std::fflush(stderr);
}

}  // namespace palpate::app
