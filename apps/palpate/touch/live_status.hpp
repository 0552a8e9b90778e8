#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palpate/ros/bridge.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// State of one hand during a run.
struct HandMoment {
  std::string name;
  ServoState servo;         ///< its last step
  double force = 0;         ///< the longest since the moment before, N
  double rate = 0;          ///< steps a second since then, Hz
  StepDurations durations;  ///< of the steps since then
  std::string silence;      ///< why its device is silent; empty: it is not
  bool ended = false;
};

/// State of a run, for its status line.
struct LiveMoment {
  double time = 0;  ///< since the run began, s
  std::vector<HandMoment> hands;
  std::vector<StreamState> streams;
  double prepared = 1;  ///< share of the clouds
  std::optional<RosBridge::RobotState> robot;
};

/// One line: "12.3 s  1.42 N  1000 Hz, 24 us (p99 61), late p99 0.09 ms | table 30.0 Hz, 11 ms".
/// Several hands are named. A stream that does not run, a device that is silent, a servo that
/// holds back and a robot that gets no targets are shown with the reason.
[[nodiscard]] std::string in_words(const LiveMoment& moment);

/// Shows moments on standard error: in one line that is rewritten ten times a second on a terminal,
/// in lines of their own, one a second, elsewhere.
class LiveStatus {
 public:
  LiveStatus();
  ~LiveStatus();
  LiveStatus(const LiveStatus&) = delete;
  LiveStatus& operator=(const LiveStatus&) = delete;

  /// Is the next moment to be shown at `time`, s since the run began?
  [[nodiscard]] bool due(double time) const { return time >= next_; }
  void show(const LiveMoment& moment);

  /// Something that happened, in a line that stays.
  void print(const std::string& words);

 private:
  bool terminal_;
  bool shown_ = false;
  double next_;  // s
};

/// The beginning of `line` that fits into `columns`, in whole characters of UTF-8.
[[nodiscard]] std::string fitted(const std::string& line, std::size_t columns);

}  // namespace palpate::app
