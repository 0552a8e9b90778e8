#pragma once

#include <limits>
#include <string>

namespace palpate::python {

/// What is known of what was pushed into a source last; times are s.
struct Pushed {
  /// Its surface starts at `start` and has faded at `end` unless another follows; proxies are at
  /// `time`, which is no number where they have made no step.
  void starts(double start, double end, double time);

  /// Why nothing of it is felt, in words; empty: nothing is known against it. `time`: as above.
  [[nodiscard]] std::string problem_at(double time) const;

  std::string problem = {};  ///< of the image itself; empty: none

 private:
  double start_ = std::numeric_limits<double>::quiet_NaN();  // no number: nothing was pushed
  double end_ = 0;
  bool gone_ = false;  // had it faded when it was pushed?
};

}  // namespace palpate::python
