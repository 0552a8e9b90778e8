// Compares the targets that a robot receives while things move with the truth.
#include "robot/trial.hpp"

namespace {

using palpate::robot::Score;

constexpr palpate::bench::Column<Score> kColumns[] = {{"told", &Score::told},
                                                      {"waits %", &Score::waits, 1, 100},
                                                      {"in sight %", &Score::needless, 1, 100},
                                                      {"again s", &Score::again, 2},
                                                      {"deepest mm", &Score::deepest},
                                                      {"unexcused", &Score::unexcused},
                                                      {"beyond", &Score::beyond},
                                                      {"late", &Score::late},
                                                      {"way back", &Score::back_depth},
                                                      {"jump", &Score::hand_moves}};
using Columns = std::span<const palpate::bench::Column<Score>>;

}  // namespace

int main(int argc, char** argv) {
  using namespace palpate;
  CLI::App app("What a robot is told, in simulated time: medians, and worst in brackets",
               "robot_bench");
  bench::SeedOptions options;
  bool proxy = false;
  bench::add_options(app, options);
  app.add_flag("--proxy", proxy, "Tell the proxy as it is, whatever is seen");
  return bench::run_main(app, argc, argv, [&] {
    fmt::print("{}", bench::table_head("", Columns(kColumns)));
    bench::print_rows(
        robot::all_rows(), options,
        [&](const robot::Trial& trial) {
          return robot::play(trial, proxy ? robot::Rule::proxy : robot::Rule::seen_free);
        },
        [](const std::string& name, const std::vector<Score>& scores) {
          return bench::table_line(name, scores, Columns(kColumns));
        },
        [](const Score& score) {
          return fmt::format("  sigma {:.1f} mm, back {:.2f} m/s; {}\n{}{}", score.sigma,
                             score.back_speed, score.reasons, score.where,
                             score.where.empty() ? "" : "\n");
        });
    return 0;
  });
}
