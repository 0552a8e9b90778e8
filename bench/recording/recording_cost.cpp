// Measures what a recording costs a servo's step and what shows it, and what a recorder costs that
// records nothing: runs at 1 kHz in real time over one way on a torus, in turns.
//
//   recording_cost [TURNS [SECONDS]]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
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

enum class Kind { alone, idle, recorded };
constexpr std::array<Kind, 3> kKinds{Kind::alone, Kind::idle, Kind::recorded};

// Prints the median of the runs, and how much more the runs of another kind take.
void tell(const char* name, double Times::*which, const char* kind,
          const std::vector<Times>& without, const std::vector<Times>& with) {
  std::vector<double> alone;
  std::vector<double> more;
  for (std::size_t i = 0; i < with.size(); ++i) {
    alone.push_back(without[i].*which);
    more.push_back(with[i].*which - without[i].*which);
  }
  const auto [least, most] = std::ranges::minmax(more);
  fmt::print("{:8} {:7.2f} us, {:8} {:+.2f} us ({:+.2f} to {:+.2f}): {:+.1f} %\n", name,
             median_of(alone), kind, median_of(more), least, most,
             100 * median_of(more) / median_of(alone));
}

Times run(LoadedScene& loaded, const Placement& plan, Kind kind) {
  const std::string path =
      (std::filesystem::temp_directory_path() / "recording_cost.mcap").string();
  SteadyClock clock;
  std::optional<Recorder> recorder;
  if (kind != Kind::alone) recorder.emplace(kind == Kind::recorded ? path : "");
  ScriptedDevice device(plan.target);
  ServoOptions options;
  options.workspace = plan.workspace;
  options.proxy.stiffness = plan.stiffness;
  options.traces = recorder ? recorder->add_hand() : nullptr;
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
    for (const RecordReport& report : recorder->finish()) {
      if (report.lost_steps > 0) fmt::print("{} steps were lost\n", report.lost_steps);
    }
    std::filesystem::remove(path);
  }
  return times_of(std::move(seconds));
}

int measure(int turns, double duration) {
  LoadedScene loaded;
  LoadedSource& source = loaded.sources.emplace_back();
  source.cloud = std::make_shared<PointCloud>(synthetic_cloud("torus"));
  loaded.scene.add("torus", *source.cloud);
  ExplorationOptions exploration;
  exploration.duration = duration;
  exploration.hand.stiffness = std::numeric_limits<double>::infinity();
  const Placement plan = plan_exploration(loaded.scene, {}, exploration);
  std::array<std::vector<Times>, 3> runs;  // of each kind
  for (int i = 0; i < turns; ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto which = static_cast<std::size_t>((i + k) % 3);
      runs[which].push_back(run(loaded, plan, kKinds[which]));
    }
  }
  for (const auto& [kind, with] : {std::pair("idle", &runs[1]), std::pair("recorded", &runs[2])}) {
    tell("p50", &Times::p50, kind, runs[0], *with);
    tell("p99", &Times::p99, kind, runs[0], *with);
    tell("longest", &Times::longest, kind, runs[0], *with);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::app

int main(int argc, char** argv) {
  const int turns = argc > 1 ? std::atoi(argv[1]) : 9;
  return palpate::app::measure(std::max(turns, 1), argc > 2 ? std::atof(argv[2]) : 3);
}
