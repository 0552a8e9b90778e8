#pragma once

#include <fmt/format.h>

#include <string>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/run/touch_statistics.hpp"

namespace palpate::app {

/// The CSV log of a run: a header, then a row a step. Numbers are the shortest that read back to
/// the same bits; `us` alone differs from run to run. The first row says whether there are columns
/// for orientation and gripper.
class TouchLog {
 public:
  explicit TouchLog(const std::string& path);
  void add(const TouchStep& step);
  void close();

 private:
  void begin(bool orientation, bool gripper);

  OutputFile file_;
  fmt::memory_buffer buffer_;
  bool begun_ = false;
};

}  // namespace palpate::app
