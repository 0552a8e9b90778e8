#pragma once

#include <fmt/format.h>

#include <string>

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

}  // namespace palpate::app
