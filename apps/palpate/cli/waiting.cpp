#include "apps/palpate/cli/waiting.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <stop_token>
#include <utility>

namespace palpate::app {

namespace {

// Until the work is over or `patience` has passed; true: it is over.
bool over(const std::stop_token& stop, std::chrono::milliseconds patience) {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::unique_lock lock(mutex);
  changed.wait_for(lock, stop, patience, [] { return false; });
  return stop.stop_requested();
}

void wait(const std::stop_token& stop, const std::string& what) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (over(stop, std::chrono::milliseconds(terminal ? 500 : 2000))) return;
  fmt::print(stderr, "{} ...{}", what, terminal ? "" : "\n");
  std::fflush(stderr);
  while (!over(stop, std::chrono::hours(1))) {
  }
  if (terminal) fmt::print(stderr, "\r\033[K");
}

}  // namespace

Waiting::Waiting(std::string what)
    : thread_([what = std::move(what)](const std::stop_token& stop) { wait(stop, what); }) {}

}  // namespace palpate::app
