#pragma once

#include <string>
#include <vector>

#include "accuracy/bench_run.hpp"

namespace palpate::accuracy {

/// One line of table A: a metric of a row, its target for one raw frame taken as unorganised
/// points, and what evaluation.md quotes for the best of three tuned CHAI3D meshes.
struct Target {
  std::string row;
  std::string metric;  ///< for the reader, with its unit
  double (*of)(const Score&) = nullptr;
  double limit = 0;    ///< the median over the frames must not be above, as an absolute
                       ///< value; < 0: no target
  std::string quoted;  ///< empty: not quoted
};

/// The targets that hold for this noise.
[[nodiscard]] std::vector<Target> targets(NoiseKind noise);

/// A metric over the frames.
struct Spread {
  double median = 0;
  double worst = 0;  ///< the largest in absolute value
};

[[nodiscard]] Spread spread(const BenchResults& results, const std::string& contender,
                            const Target& target);

/// Is the target met by this contender's median (or is there none)?
[[nodiscard]] bool met(const BenchResults& results, const std::string& contender,
                       const Target& target);

/// Table A as Markdown. Medians, in brackets the worst frame.
[[nodiscard]] std::string markdown_table(const BenchResults& results,
                                         const std::vector<Contender>& contenders,
                                         const BenchOptions& options);

/// What preparation chose, one line a contender and the first frame.
[[nodiscard]] std::string markdown_preparation(const BenchResults& results);

/// Every score as comma-separated values with a header line.
[[nodiscard]] std::string csv(const BenchResults& results, const BenchOptions& options);

}  // namespace palpate::accuracy
