#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/main.hpp"

/// Tables whose rows are drawn: each row is played with several seeds, and a line of the table
/// holds medians over the seeds, with the worst in brackets.
namespace palpate::bench {

/// One kind of trial; `draw` adds it to a trial that is made from a seed.
template <class Trial>
struct Row {
  std::string name;
  std::function<void(Trial&)> draw;
};

template <class Score>
struct Column {
  const char* name;
  double Score::*of;
  int digits = 1;
  double unit = 1;          ///< the member is multiplied by it
  bool high_is_bad = true;  ///< else low values are
};

/// Names of columns and the rule below; `label` is that of the first, or of several ("a | b").
template <class Score>
[[nodiscard]] std::string table_head(const std::string& label,
                                     std::span<const Column<Score>> columns) {
  std::string text = label.empty() ? "| |" : "| " + label + " |";
  std::string rule = "|";
  for (auto i = std::ranges::count(text, '|'); i > 1; --i) rule += "---|";
  for (const Column<Score>& column : columns) {
    text += fmt::format(" {} |", column.name);
    rule += "---|";
  }
  return text + "\n" + rule + "\n";
}

/// Median (worst) of each column.
template <class Score>
[[nodiscard]] std::string table_line(const std::string& label, const std::vector<Score>& scores,
                                     std::span<const Column<Score>> columns) {
  std::string text = fmt::format("| {} |", label);
  for (const Column<Score>& column : columns) {
    std::vector<double> values;
    for (const Score& score : scores) values.push_back(column.unit * score.*column.of);
    std::ranges::sort(values);
    text += fmt::format(" {:.{}f} ({:.{}f}) |", values[values.size() / 2], column.digits,
                        column.high_is_bad ? values.back() : values.front(), column.digits);
  }
  return text + "\n";
}

/// Plays every wanted row with every seed and prints `line(name, scores)` for each row; with
/// options.each also for each seed, and `detail(score)` below.
template <class Trial, class Play, class Line, class Detail>
void print_rows(const std::vector<Row<Trial>>& rows, const SeedOptions& options, const Play& play,
                const Line& line, const Detail& detail) {
  for (const Row<Trial>& row : rows) {
    if (!is_wanted(row.name, options.names)) continue;
    std::vector<std::invoke_result_t<Play, const Trial&>> scores;
    for (int i = 0; i < options.seeds; ++i) {
      const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
      Trial trial(seed);
      row.draw(trial);
      scores.push_back(play(trial));
      if (!options.each) continue;
      fmt::print("{}{}", line(fmt::format("{}, seed {}", row.name, seed), {scores.back()}),
                 detail(scores.back()));
    }
    fmt::print("{}", line(row.name, scores));
    std::fflush(stdout);
  }
}

}  // namespace palpate::bench
