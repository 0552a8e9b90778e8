#pragma once

#include <array>
#include <csignal>
#include <string>
#include <vector>

namespace palpate::app {

/// Runs a program to its end, all that it writes in the file `output`, and returns its exit code;
/// 127: it is not there, 126: a signal ended it.
[[nodiscard]] int run_program(const std::vector<std::string>& words, const std::string& output);

/// While it lives, Ctrl-C (SIGINT), SIGTERM and a terminal that is closed (SIGHUP, unless the
/// program was started to outlive it: nohup) request the program to come to an end instead of
/// ending it. Once: the second one of a kind ends it. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] bool requested() const noexcept;

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

  std::array<struct sigaction, kSignals.size()> before_ = {};
};

/// The person's browser, opened at an address that others of the machine must not learn: it is in
/// no command line, but in a file that the person alone may read and that leads there. Removed at
/// the end.
class Browser {
 public:
  /// Opens nothing where there is no browser, no desktop or no folder for the file.
  explicit Browser(const std::string& url);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

 private:
  std::string file_;
};

}  // namespace palpate::app
