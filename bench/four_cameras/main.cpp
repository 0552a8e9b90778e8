// Four cameras at 30 Hz and the servo at 1 kHz: what is felt how late, and what cameras cost it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "four_cameras/servo_run.hpp"
#include "palpate/base/error.hpp"
#include "palpate/servo/realtime.hpp"

namespace {

using namespace palpate;
using namespace palpate::four_cameras;

constexpr double kMostRiseP50 = 0.10;
constexpr double kMostRiseP99 = 0.20;

struct Options {
  double seconds = 60;
  int pairs = 9;
  double pair_seconds = 3;
  std::optional<int> processor = {};
};

// Of values in rising order.
double quantile(const std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto last = static_cast<double>(values.size()) - 1;
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

void print_drops(const RunResult& run) {
  fmt::print("| camera | frames | touchable | rate | latency mean | worst | dropped |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const StreamState& stream : run.streams) {
    const StreamDrops& drops = stream.drops;
    fmt::print("| {} | {} | {} | {:.1f} Hz | {:.1f} ms | {:.0f} ms | overtaken {}, other {} |\n",
               stream.source, stream.frames, stream.touchable, stream.rate,
               1e3 * stream.latency_mean, 1e3 * stream.latency_worst, drops.overtaken,
               drops.total() - drops.overtaken);
  }
}

void print_wall(const RunResult& run) {
  fmt::print("age of what is felt: p50 {:.1f} ms, p99 {:.1f} ms, max {:.1f} ms\n\n",
             1e3 * quantile(run.ages, 0.5), 1e3 * quantile(run.ages, 0.99),
             1e3 * quantile(run.ages, 1));
  print_drops(run);
  const Durations& late = run.lateness;
  fmt::print(
      "\n{} steps, {:.0f} % touching, {} left out; late p50 {:.3f} ms, p99 {:.3f} ms, max {:.1f} "
      "ms; computing p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us; faults {}; waits for a lock: "
      "{}\n\n",
      run.steps, 100.0 * static_cast<double>(run.touching) / static_cast<double>(run.steps),
      run.skipped, 1e3 * late.quantile(0.5), 1e3 * late.quantile(0.99), 1e3 * late.longest,
      1e6 * quantile(run.computing, 0.5), 1e6 * quantile(run.computing, 0.99),
      1e6 * quantile(run.computing, 1), run.faults, run.lock_waits);
  fmt::print("{}\n", in_words(run.realtime));
}

// Computing times of interleaved runs, as ratios.
struct Pairs {
  std::vector<double> p50, p99;              // with cameras over moving surfaces without
  std::vector<double> p50_still, p99_still;  // over surfaces that stand still
  std::int64_t lock_waits = 0;

  void add(const RunResult& still, const RunResult& moving, const RunResult& cameras) {
    const auto ratio = [&](const RunResult& to, double share) {
      return quantile(cameras.computing, share) / quantile(to.computing, share);
    };
    p50.push_back(ratio(moving, 0.5));
    p99.push_back(ratio(moving, 0.99));
    p50_still.push_back(ratio(still, 0.5));
    p99_still.push_back(ratio(still, 0.99));
    lock_waits += cameras.lock_waits;
  }
};

bool print_pairs(const Pairs& pairs) {
  const double rise50 = median(pairs.p50) - 1;
  const double rise99 = median(pairs.p99) - 1;
  const bool met = rise50 <= kMostRiseP50 && rise99 <= kMostRiseP99 && pairs.lock_waits == 0;
  fmt::print("computing time of a step with four cameras, medians of {} interleaved runs:\n\n",
             pairs.p50.size());
  fmt::print("| against | p50 | p99 |\n|---|---|---|\n");
  fmt::print("| moving surfaces, no cameras | {:+.1f} % | {:+.1f} % |\n", 100 * rise50,
             100 * rise99);
  fmt::print("| surfaces that stand still | {:+.1f} % | {:+.1f} % |\n",
             100 * (median(pairs.p50_still) - 1), 100 * (median(pairs.p99_still) - 1));
  fmt::print("\ntargets (+10 %, +20 % against moving surfaces; no wait for a lock): {}\n",
             met ? "met" : "MISSED");
  return met;
}

// The servo's processor is its own: what prepares frames would sweep out its caches.
void give_processor(const Options& options) {
  if (!options.processor) return;
  fmt::print("{}\n", in_words(RealtimeReport{{leave_processor(*options.processor)}}));
}

int run(const Options& options) {
  give_processor(options);
  SteadyWaitingClock clock;
  CameraRig rig(clock);
  Scene scene;
  CameraRig::add_sources(scene);
  rig.show_once(scene);
  if (options.seconds > 0) {
    print_wall(run_servo(rig, hand_over(scene, options.seconds), Beside::cameras, clock,
                         options.processor));
  }
  const Trajectory hand = hand_over(scene, options.pair_seconds);
  Pairs pairs;
  for (int i = 0; i < options.pairs; ++i) {
    const RunResult still = run_servo(rig, hand, Beside::still, clock, options.processor);
    const RunResult moving = run_servo(rig, hand, Beside::moving, clock, options.processor);
    pairs.add(still, moving, run_servo(rig, hand, Beside::cameras, clock, options.processor));
  }
  return pairs.p50.empty() || print_pairs(pairs) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Four cameras at 30 Hz and the servo at 1 kHz");
  Options options;
  app.add_option("--seconds", options.seconds, "Of the run whose wall figures are told; 0: none")
      ->check(CLI::Range(0.0, 3600.0));
  app.add_option("--pairs", options.pairs, "Interleaved runs")->check(CLI::Range(0, 100));
  app.add_option("--pair-seconds", options.pair_seconds, "Of each of them")
      ->check(CLI::Range(0.5, 60.0));
  app.add_option("--processor", options.processor,
                 "The servo is pinned to this one, and everything else leaves it");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "four_cameras_bench: {}\n", error.what());
    return 2;
  }
}
