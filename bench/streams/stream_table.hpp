#pragma once

#include <string>
#include <vector>

#include "streams/stream_experiments.hpp"

namespace palpate::streams {

/// One number of table B that the default has to meet.
struct Target {
  std::string experiment;
  std::string metric;  ///< for the reader, with its unit
  double (*of)(const Measures&) = nullptr;
  double limit = 0;    ///< not above, as an absolute value
  std::string paper;   ///< quoted for the paper's way; empty: nothing
  std::string chai3d;  ///< likewise
};

[[nodiscard]] std::vector<Target> targets();

/// The default's value; none where the experiment was not run.
[[nodiscard]] std::vector<double> values(const std::vector<Result>& results, const Target& target);

/// Targets with what was measured and whether they are met.
[[nodiscard]] std::string markdown_targets(const std::vector<Result>& results);

/// Everything that was measured in one experiment, one line a contender and tool.
[[nodiscard]] std::string markdown_experiment(const std::vector<Result>& results);

}  // namespace palpate::streams
