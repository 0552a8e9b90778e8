#pragma once

#include <fmt/format.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "palpate/device/device.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// The CSV log of a run: a header, then a row a step. Numbers are the shortest that read back to
/// the same bits; `us` alone differs from run to run. The device, which is the same in every row,
/// says whether there are columns for orientation and gripper.
class TouchLog {
 public:
  explicit TouchLog(const std::string& path);
  void add(const ServoState& step, const DeviceInfo& device);
  void close();

 private:
  void begin(bool orientation, bool gripper);

  OutputFile file_;
  fmt::memory_buffer buffer_;
  bool begun_ = false;
};

/// The log of steps that a page begins and ends while a run goes on: a file a hand. What is being
/// recorded when it goes is kept.
class Recording {
 public:
  /// `broken` is told why when a step cannot be written: then it has ended by itself, and the run
  /// goes on.
  Recording(std::size_t hands, std::function<void(const std::string&)> broken)
      : hands_(hands), broken_(std::move(broken)) {}
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Begins files named after the time of day, or ends those that were begun; what goes on already
  /// goes on. Returns the first one's name.
  /// @throws Error when they cannot be made, and nothing changes, or not be written to the end.
  std::string record(bool on);

  /// Another thread's: a step of a hand.
  void add(std::size_t hand, const ServoState& step, const DeviceInfo& device);

 private:
  void begin();
  std::string end();

  std::size_t hands_;
  std::function<void(const std::string&)> broken_;
  std::mutex mutex_;
  std::string name_;
  std::vector<TouchLog> logs_;  // empty: nothing is recorded
};

}  // namespace palpate::app
