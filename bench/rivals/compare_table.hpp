#pragma once

#include <string>
#include <vector>

#include "rivals/compare.hpp"

namespace palpate::rivals {

/// Who the methods are, one a line.
[[nodiscard]] std::string markdown_methods(const std::vector<Method>& methods);

/// A table a metric (normal, force, lost, largest step, energy), methods down and rows across:
/// medians over the frames with the worst in brackets, the first of each row in bold.
[[nodiscard]] std::string markdown_scores(const accuracy::BenchResults& results,
                                          const std::vector<Method>& methods);

/// The rows in which another method's median is better than that of `ours` by more than a tenth.
[[nodiscard]] std::string markdown_behind(const accuracy::BenchResults& results,
                                          const std::vector<Method>& methods);

/// Medians over the frames. They differ from run to run.
[[nodiscard]] std::string markdown_times(const std::vector<Times>& times,
                                         const std::vector<Method>& methods);

/// Mean over all rows that are scored of the method's median force error, N.
[[nodiscard]] double mean_force_error(const accuracy::BenchResults& results,
                                      const std::string& method);

}  // namespace palpate::rivals
