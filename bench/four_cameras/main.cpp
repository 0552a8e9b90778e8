// Four cameras at 30 Hz and the servo at 1 kHz: what is felt how late, and what cameras cost it.

#include <fmt/format.h>

#include "four_cameras/servo_run.hpp"
#include "servo_cost/measured.hpp"
#include "servo_cost/rises.hpp"

namespace {

using namespace palpate;
using namespace palpate::four_cameras;
using servo_cost::CostOptions;
using servo_cost::hand_over;
using servo_cost::quantile;
using servo_cost::Rises;

void print_drops(const RunResult& run) {
  fmt::print("| camera | frames | touchable | rate | latency mean | worst | dropped |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const StreamState& stream : run.streams) {
    const StreamState::Drops& drops = stream.drops;
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
  fmt::print("\n{}\n\n", in_words(run.servo));
  fmt::print("{}\n", in_words(run.servo.realtime));
}

bool print_rises(const Rises& moving, const Rises& still) {
  fmt::print("computing time of a step with four cameras, medians of {} interleaved runs:\n\n",
             moving.pairs());
  fmt::print("{}\n{}\n{}\n", servo_cost::rises_head(),
             row_of(moving, "moving surfaces, no cameras"),
             row_of(still, "surfaces that stand still"));
  fmt::print("\ntargets (+10 %, +20 % against moving surfaces; no wait for a lock): {}\n",
             moving.met() ? "met" : "MISSED");
  return moving.met();
}

bool run(const CostOptions& options) {
  SteadyClock clock;
  CameraRig rig(clock);
  Scene scene;
  CameraRig::add_sources(scene);
  rig.show_once(scene);
  if (options.seconds > 0) {
    print_wall(run_servo(rig, hand_over(scene, options.seconds), Beside::cameras, clock,
                         options.processor));
  }
  const Trajectory hand = hand_over(scene, options.pair_seconds);
  const auto servo_beside = [&](Beside beside) {
    return run_servo(rig, hand, beside, clock, options.processor).servo;
  };
  Rises moving, still;
  for (int i = 0; i < options.pairs; ++i) {
    const servo_cost::ServoRun without_motion = servo_beside(Beside::still);
    const servo_cost::ServoRun without = servo_beside(Beside::moving);
    const servo_cost::ServoRun with = servo_beside(Beside::cameras);
    moving.add(with, without);
    still.add(with, without_motion);
  }
  return options.pairs == 0 || print_rises(moving, still);
}

}  // namespace

int main(int argc, char** argv) {
  return servo_cost::run_measured("four_cameras_bench",
                                  "Four cameras at 30 Hz and the servo at 1 kHz", argc, argv, run);
}
