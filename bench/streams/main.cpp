// Table B of the evaluation: depth streams with known truth, touched in simulated time.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "palpate/base/error.hpp"
#include "streams/stream_table.hpp"

namespace {

using namespace palpate::streams;

int run(const Options& options) {
  const std::vector<Experiment> experiments = make_experiments(options);
  if (experiments.empty()) throw palpate::Error("no experiment matches --only; try press or ball");
  std::vector<Result> all;
  for (const Experiment& experiment : experiments) {
    const std::vector<Result> results = run_experiment(experiment);
    fmt::print("### {}\n\n{}\n", experiment.name, markdown_experiment(results));
    all.insert(all.end(), results.begin(), results.end());
  }
  fmt::print("### Targets\n\n{}", markdown_targets(all));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Streams with known truth, in simulated time");
  Options options;
  app.add_option("--seconds", options.seconds, "Scored time of each run")
      ->check(CLI::Range(0.5, 60.0));
  app.add_option("--seeds", options.seeds, "Runs with different noise")->check(CLI::Range(1, 100));
  app.add_option("--first-seed", options.first_seed, "Seed of the first run");
  app.add_option("--only", options.names, "Experiments whose names hold one of these")
      ->delimiter(',');
  app.add_flag("--ours", options.ours_alone, "The default alone");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "streams_bench: {}\n", error.what());
    return 1;
  }
}
