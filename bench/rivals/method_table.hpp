#pragma once

#include "common/rows.hpp"

namespace palpate::rivals {

/// A line for each method; `seeds` holds the scores of all methods for one seed after another.
template <class Score>
[[nodiscard]] std::string method_table(const std::string& title,
                                       const std::vector<std::string>& methods,
                                       const std::vector<std::vector<Score>>& seeds,
                                       std::span<const bench::Column<Score>> columns) {
  std::string text =
      fmt::format("### {}\n\n{}", title, bench::table_head<Score>("method", columns));
  for (std::size_t k = 0; k < methods.size(); ++k) {
    std::vector<Score> scores;
    for (const std::vector<Score>& seed : seeds) scores.push_back(seed[k]);
    text += bench::table_line<Score>(methods[k], scores, columns);
  }
  return text + "\n";
}

}  // namespace palpate::rivals
