#pragma once

#include <map>
#include <string>
#include <vector>

#include "accuracy/contender.hpp"
#include "accuracy/rows.hpp"
#include "accuracy/truth_frame.hpp"

namespace palpate::accuracy {

struct BenchOptions {
  int layout = 0;
  int seeds = 8;
  std::uint64_t first_seed = 1;
  NoiseKind noise = NoiseKind::independent;
  bool silhouettes = false;
  std::vector<std::string> rows;  ///< only rows whose names hold one of these; empty: all
};

/// The score of one contender on one row of one frame.
struct Result {
  std::uint64_t seed = 0;
  std::string contender;
  std::string row;
  Score score;
};

/// What preparation chose for a frame.
struct Preparation {
  std::uint64_t seed = 0;
  std::string contender;
  PrepareReport report;
  SourceState state;
};

struct BenchResults {
  std::vector<Result> results;
  std::vector<Preparation> preparations;
};

/// Scores every contender on every row, with as many frames as there are seeds.
[[nodiscard]] BenchResults run_bench(const BenchOptions& options,
                                     const std::vector<Contender>& contenders);

}  // namespace palpate::accuracy
