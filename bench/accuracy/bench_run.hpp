#pragma once

#include <map>
#include <string>
#include <vector>

#include "accuracy/contender.hpp"
#include "accuracy/rows.hpp"
#include "accuracy/truth_frame.hpp"

/// Runs of table A: options, results and who plays them.
namespace palpate::accuracy {

struct BenchOptions {
  int layout = 0;   ///< a fixed one, where none is drawn
  int layouts = 0;  ///< so many are drawn
  std::uint64_t first_layout = 1;
  int seeds = 8;  ///< frames of a layout
  std::uint64_t first_seed = 1;
  NoiseKind noise = NoiseKind::independent;
  double rounding = 1e-3;  ///< of depths, m; 0: none
  bool silhouettes = false;
  double correlation = 0;  ///< of the noise, pixels; 0: as its kind says
  double sigma = 0;        ///< deviation of the noise at all depths, m; 0: as a Kinect's
  double terraces = 0;  ///< steps of depth at a plane's distance, of layouts at 0.7 m, m; 0: none
  double uneven = 1;    ///< times the error where a flat thing is touched
  bool fine = false;    ///< 1280 x 720 pixels, 900 to a unit of the ray; single things alone
  std::vector<std::string> rows;  ///< only rows whose names hold one of these; empty: all
};

/// The score of one contender on one row of one frame.
struct Result {
  std::uint64_t seed = 0;
  std::string contender;
  std::string row;
  Score score;
  std::uint64_t layout = 0;
};

/// The choices of preparation for a frame.
struct Preparation {
  std::uint64_t seed = 0;
  std::string contender;
  Prepared::Report report;
  Source::State state;
};

struct BenchResults {
  std::vector<Result> results;
  std::vector<Preparation> preparations;
};

/// The noise that benches call by a letter: a independent, b blurred, c quantised, else none.
[[nodiscard]] NoiseKind noise_kind(const std::string& letter);

/// The camera that sees single things.
[[nodiscard]] TruthCamera camera_of(const BenchOptions& options);

/// The noise added to the exact depths of a frame. Each drawn layout has noise of its own.
[[nodiscard]] SimulatedNoiseOptions noise_of(const BenchOptions& options, std::uint64_t layout,
                                             std::uint64_t seed);

/// Scores every contender on every row, with as many frames of every layout as there are seeds.
[[nodiscard]] BenchResults run_bench(const BenchOptions& options,
                                     const std::vector<Contender>& contenders);

}  // namespace palpate::accuracy
