#pragma once

#include <fmt/format.h>

#include <string>

#include "apps/palpate/cli/output.hpp"
#include "palpate/device/device.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// The CSV log of a run: a header, then a row a step. Numbers are the shortest that read back to
/// the same bits; `us` alone differs from run to run. The device, which is the same in every row,
/// decides whether there are columns for orientation and gripper; a log of a tool that turns has
/// these, and more for the tool's pose and the wrench. What is not closed stays beside its target
/// (OutputFile).
class TouchLog {
 public:
  /// `turns`: the steps are those of a tool that turns.
  explicit TouchLog(const std::string& path, bool turns = false);
  /// Writes the rest, unless close() was called.
  ~TouchLog();
  /// `scale`: metres of the world for one of the device (Workspace).
  /// @throws Error when the file cannot be written, and takes nothing from then on.
  void add(const ServoState& step, const DeviceInfo& device, double scale);
  /// @throws Error when it cannot, or could not be written.
  void close();

 private:
  void begin(bool orientation, bool gripper);
  void flush();

  OutputFile file_;
  bool turns_;
  fmt::memory_buffer buffer_;
  bool begun_ = false;
  std::string problem_;  // why it ended; empty: it did not
};

}  // namespace palpate::app
