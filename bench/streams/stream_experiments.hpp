#pragma once

#include <string>
#include <vector>

#include "streams/stream_measures.hpp"

namespace palpate::streams {

/// Set-ups that are scored together, and who is to play them.
struct Experiment {
  std::string name;
  std::vector<Setup> setups;
  std::vector<Contender> contenders;
};

struct Options {
  double seconds = 2;  ///< that are scored of what stands or moves evenly
  int seeds = 1;
  std::uint64_t first_seed = 1;
  bool ours_alone = false;         ///< the default only, without other policies and the paper's way
  std::vector<std::string> names;  ///< only experiments whose names hold one of these; empty: all
};

/// Table B of the evaluation.
[[nodiscard]] std::vector<Experiment> make_experiments(const Options& options);

struct Result {
  std::string experiment;
  std::string contender;
  std::string tool;
  Measures measures;
};

/// Joins what several set-ups gave: means of squares, largest steps, sums of pops.
[[nodiscard]] Measures together(const std::vector<Measures>& all);

/// One result a contender and tool.
[[nodiscard]] std::vector<Result> run_experiment(const Experiment& experiment);

}  // namespace palpate::streams
