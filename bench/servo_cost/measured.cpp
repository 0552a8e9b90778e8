// Reads the options of programs that measure a servo's cost.
#include "servo_cost/measured.hpp"

#include "common/main.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::servo_cost {

namespace {

// The servo's processor is its own: what else runs would sweep out its caches.
void give_processor(const CostOptions& options) {
  if (!options.processor) return;
  fmt::print("{}\n", in_words(RealtimeReport{{leave_processor(*options.processor)}}));
}

}  // namespace

int run_measured(const std::string& name, const std::string& description, int argc, char** argv,
                 const std::function<bool(const CostOptions&)>& run) {
  CLI::App app(description, name);
  CostOptions options;
  app.add_option("--seconds", options.seconds, "Of the run whose wall figures are told; 0: none")
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--pairs", options.pairs, "Interleaved runs")->check(CLI::Range(0, 100));
  app.add_option("--pair-seconds", options.pair_seconds, "Of each of them")
      ->check(CLI::Range(0.5, 60.0));
  app.add_option("--processor", options.processor,
                 "The servo is pinned to this one, and everything else leaves it");
  const auto measure = [&] {
    give_processor(options);
    return run(options) ? 0 : 1;
  };
  return bench::run_main(app, argc, argv, measure, 2);
}

}  // namespace palpate::servo_cost
