// What a recording costs a servo's step and what shows it: pairs of runs at 1 kHz in real time over
// one way on a torus, one of each pair recorded, one not, in turns.
//
//   recording_cost [PAIRS [SECONDS]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "apps/palpate/record/recorder.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {
namespace {

struct Times {
  double p50 = 0;  // us
  double p99 = 0;
  double longest = 0;
};

Times times_of(std::vector<double> seconds) {
  std::ranges::sort(seconds);
  const auto at = [&](double share) {
    return 1e6 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  return {at(0.5), at(0.99), at(1)};
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// Of each run, and how much more it is in the recorded one of a pair.
void tell(const char* name, double Times::*which, const std::vector<Times>& without,
          const std::vector<Times>& with) {
  std::vector<double> alone;
  std::vector<double> more;
  for (std::size_t i = 0; i < with.size(); ++i) {
    alone.push_back(without[i].*which);
    more.push_back(with[i].*which - without[i].*which);
  }
  const auto [least, most] = std::ranges::minmax(more);
  fmt::print("{:8} {:7.2f} us, recorded {:+.2f} us ({:+.2f} to {:+.2f}): {:+.1f} %\n", name,
             median_of(alone), median_of(more), least, most,
             100 * median_of(more) / median_of(alone));
}

Times run(LoadedScene& loaded, const Placement& plan, bool recorded) {
  const std::string path =
      (std::filesystem::temp_directory_path() / "recording_cost.mcap").string();
  SteadyClock clock;
  std::optional<Recorder> recorder;
  if (recorded) recorder.emplace(path);
  ScriptedDevice device(plan.target);
  ServoOptions options;
  options.workspace = plan.workspace;
  options.proxy.stiffness = plan.stiffness;
  options.traces = recorded ? recorder->add_hand() : nullptr;
  Servo servo(device, loaded.scene, options);
  if (recorder) recorder->begin(loaded, {&servo}, clock.now(), false);
  std::vector<double> seconds;
  seconds.reserve(plan.target.size());
  const double start = clock.now();
  for (DeviceState state = device.read(); state.status == DeviceState::Status::ok;
       state = device.read()) {
    clock.wait_until(start + state.time);
    const double begin = thread_cpu_seconds();
    servo.step(state, clock.now());
    servo.show();
    seconds.push_back(thread_cpu_seconds() - begin);
  }
  if (recorder) {
    const RecordReport report = recorder->finish();
    if (report.lost_steps > 0) fmt::print("{} steps were lost\n", report.lost_steps);
    std::filesystem::remove(path);
  }
  return times_of(std::move(seconds));
}

int measure(int pairs, double duration) {
  LoadedScene loaded;
  LoadedSource& source = loaded.sources.emplace_back();
  source.cloud = std::make_shared<PointCloud>(synthetic_cloud("torus"));
  loaded.scene.add("torus", *source.cloud);
  ExplorationOptions exploration;
  exploration.duration = duration;
  exploration.hand.stiffness = std::numeric_limits<double>::infinity();
  const Placement plan = plan_exploration(loaded.scene, {}, exploration);
  std::vector<Times> without;
  std::vector<Times> with;
  for (int i = 0; i < pairs; ++i) {
    for (const bool recorded : {i % 2 == 0, i % 2 != 0}) {
      (recorded ? with : without).push_back(run(loaded, plan, recorded));
    }
  }
  tell("p50", &Times::p50, without, with);
  tell("p99", &Times::p99, without, with);
  tell("longest", &Times::longest, without, with);
  return 0;
}

}  // namespace
}  // namespace palpate::app

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 9;
  return palpate::app::measure(std::max(pairs, 1), argc > 2 ? std::atof(argv[2]) : 3);
}
