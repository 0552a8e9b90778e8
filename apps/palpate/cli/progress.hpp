#pragma once

#include <chrono>
#include <string>

namespace palpate::app {

/// Says on standard error how far something is: in one line that is rewritten on a terminal; in
/// lines of their own, after two seconds and then every five, elsewhere.
class Progress {
 public:
  /// `what` is being done: "reading table.ply".
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done`: 0 to 1.
  void update(double done);

 private:
  using Clock = std::chrono::steady_clock;
  void show(double done);

  std::string what_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point next_;
};

}  // namespace palpate::app
