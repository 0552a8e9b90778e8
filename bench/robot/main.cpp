// What a robot is told while things move before its cameras, beside the truth.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "robot/trial.hpp"

namespace {

using namespace palpate::robot;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0 : values[values.size() / 2];
}

template <class Member>
std::string both(const std::vector<Score>& scores, Member member, double unit = 1) {
  std::vector<double> values;
  for (const Score& score : scores) values.push_back(unit * static_cast<double>(score.*member));
  return fmt::format("{:.1f} ({:.1f})", median(values), std::ranges::max(values));
}

std::string line(const std::string& name, const std::vector<Score>& scores) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name,
                     both(scores, &Score::told), both(scores, &Score::waits, 100),
                     both(scores, &Score::needless, 100), both(scores, &Score::deepest),
                     both(scores, &Score::unexcused), both(scores, &Score::late),
                     both(scores, &Score::back_depth), both(scores, &Score::hand_moves));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What a robot is told, in simulated time: medians, and worst in brackets");
  std::vector<std::string> names;
  std::uint64_t first_seed = 1;
  int seeds = 5;
  bool each = false;
  bool proxy = false;
  app.add_option("--only", names, "Rows whose names hold one of these");
  app.add_option("--seeds", seeds, "Trials a row")->check(CLI::Range(1, 10000));
  app.add_option("--first-seed", first_seed, "Seed of the first trial");
  app.add_flag("--each", each, "A line a seed");
  app.add_flag("--proxy", proxy, "Tell the proxy as it is, whatever is seen");
  CLI11_PARSE(app, argc, argv);
  try {
    fmt::print(
        "| | told | waits % | in sight % | deepest mm | unexcused | late | way back | jump |\n");
    fmt::print("|---|---|---|---|---|---|---|---|---|\n");
    for (const Row& row : all_rows()) {
      const auto named = [&](const std::string& part) {
        return row.name.find(part) != std::string::npos;
      };
      if (!names.empty() && std::none_of(names.begin(), names.end(), named)) continue;
      std::vector<Score> scores;
      for (int i = 0; i < seeds; ++i) {
        const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
        scores.push_back(play(row.make(seed), proxy ? Rule::proxy : Rule::seen_free));
        if (!each) continue;
        fmt::print("{}  sigma {:.1f} mm, back {:.2f} m/s; {}\n",
                   line(fmt::format("{}, seed {}", row.name, seed), {scores.back()}),
                   scores.back().sigma, scores.back().back_speed, scores.back().reasons);
        std::fflush(stdout);
      }
      fmt::print("{}", line(row.name, scores));
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "robot_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
