#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "palpate/servo/guard.hpp"
#include "palpate/viewer/viewer_options.hpp"
#include "viewer/notice.hpp"

namespace palpate::viewer {

/// The latched fault of a device, if there is one.
struct DeviceFault {
  std::string name;
  GuardFault fault = GuardFault::none;
};

/// What is wrong with streams and devices: tells what is new, and knows what lasts. One thread uses
/// it.
class Troubles {
 public:
  /// A problem that comes again after so long, in s of the stream's clock, is a new one.
  static constexpr double kPeace = 10;

  /// What is new since the look before. Each index stands for the same device in every look.
  [[nodiscard]] std::vector<Notice> look(std::span<const ViewerStream> streams,
                                         std::span<const DeviceFault> devices);

  /// What was wrong at the last look and goes on, for those who come later.
  [[nodiscard]] const std::vector<Notice>& present() const { return present_; }

 private:
  struct Problem {
    std::string words;
    double time = 0;
  };

  [[nodiscard]] bool is_new(const StreamState& stream);

  std::map<std::string, Problem> problems_;  // the last one of each source
  std::map<std::size_t, GuardFault> faults_;
  std::vector<Notice> present_;
};

}  // namespace palpate::viewer
