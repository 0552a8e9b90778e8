#pragma once

#include <string>
#include <vector>

#include "accuracy/bench_run.hpp"

namespace palpate::accuracy {

/// Upper bounds of absolute values over several frames; < 0: no target.
struct Limit {
  double median = -1;
  double worst = -1;
};

/// The bounds as text, "median (worst)"; `none` without a target.
[[nodiscard]] std::string limit_text(const Limit& limit, const char* none);

/// One line of table A: a metric of a row, its targets for one raw frame, and what is
/// quoted for the best of three tuned CHAI3D meshes.
struct Target {
  std::string row;
  std::string metric;  ///< for the reader, with its unit
  double (*of)(const Score&) = nullptr;
  Limit points;        ///< taken as unorganised points
  Limit organised;     ///< taken as a depth frame
  std::string quoted;  ///< empty: not quoted
};

/// The target of a contender; only palpate's two defaults have any.
[[nodiscard]] Limit limit_of(const Target& target, const std::string& contender);

/// The targets that hold for this noise.
[[nodiscard]] std::vector<Target> targets(NoiseKind noise);

/// A metric over the frames.
struct Spread {
  double median = 0;
  double worst = 0;  ///< the largest in absolute value
};

[[nodiscard]] Spread spread(std::vector<double> values);
[[nodiscard]] Spread spread(const BenchResults& results, const std::string& contender,
                            const Target& target);

/// Is the target met by this contender (or is there none)?
[[nodiscard]] bool met(const BenchResults& results, const std::string& contender,
                       const Target& target);

/// Table A as Markdown. Medians, in brackets the worst frame.
[[nodiscard]] std::string markdown_table(const BenchResults& results,
                                         const std::vector<Contender>& contenders,
                                         const BenchOptions& options);

/// The choices of preparation for the first frame, one line a contender.
[[nodiscard]] std::string markdown_preparation(const BenchResults& results);

/// The line above those of csv().
[[nodiscard]] std::string csv_header();

/// Every score as comma-separated values.
[[nodiscard]] std::string csv(const BenchResults& results, const BenchOptions& options);

}  // namespace palpate::accuracy
