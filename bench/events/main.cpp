// What comes, goes, is hidden, moves fast, is thin or ends, as a hand feels it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "events/rows.hpp"
#include "events/score.hpp"
#include "palpate/base/error.hpp"

int main(int argc, char** argv) {
  using namespace palpate::events;
  CLI::App app("Streams in which things happen, in simulated time: medians, and worst in brackets");
  std::vector<std::string> names;
  std::uint64_t first_seed = 1;
  int seeds = 5;
  bool each = false;
  app.add_option("--only", names, "Rows whose names hold one of these");
  app.add_option("--seeds", seeds, "Runs a row")->check(CLI::Range(1, 10000));
  app.add_option("--first-seed", first_seed, "Seed of the first run");
  app.add_flag("--each", each, "A line a seed");
  CLI11_PARSE(app, argc, argv);
  try {
    fmt::print("{}", heading());
    std::vector<Row> rows = all_rows();
    for (Row& row : sensor_rows()) rows.push_back(std::move(row));
    for (Row& row : hostile_rows()) rows.push_back(std::move(row));
    for (Row& row : fault_rows()) rows.push_back(std::move(row));
    for (const Row& row : rows) {
      const auto named = [&](const std::string& part) {
        return row.name.find(part) != std::string::npos;
      };
      if (!names.empty() && std::none_of(names.begin(), names.end(), named)) continue;
      std::vector<Score> scores;
      for (int i = 0; i < seeds; ++i) {
        const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
        const Event event = row.make(seed);
        scores.push_back(score(event, play(event)));
        if (each)
          fmt::print("{}", line(fmt::format("{}, seed {}", row.name, seed), {scores.back()}));
      }
      fmt::print("{}", line(row.name, scores));
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "events_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
