// Measures how often drivers of hardware can exchange a force for a place, against the doubles that
// tests use, and what a servo's step costs with everything between a surface and a hand. Rows of
// the first kind say exchange/DRIVER, of the second step/SURFACE; those tell quantiles of the
// thread's computing time, us.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "device/double_library.hpp"
#include "device/drivers.hpp"
#include "device/fake_haply_service.hpp"
#include "device/fake_hd.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::bench {
namespace {

using Opened = std::unique_ptr<DeviceDriver>;

void exchange_all(benchmark::State& state, DeviceDriver& link) {
  for ([[maybe_unused]] const auto& each : state) {
    benchmark::DoNotOptimize(link.exchange({0.1, 0, 0}));
  }
  state.SetItemsProcessed(state.iterations());
}

void exchange_forcedimension(benchmark::State& state) {
  const SteadyClock clock;
  const device::DeviceName name{"forcedimension", "", {{"library", PALPATE_FAKE_DHD}}};
  exchange_all(state, *device::open_forcedimension(name, clock));
}

// An exchange waits for the scheduler's next call, `pause` (s) after the last.
void exchange_openhaptics(benchmark::State& state, double pause) {
  const test::DoubleLibrary library(PALPATE_FAKE_HD);
  const test::FakeHd hardware{.pause = pause};
  library.find<void(const test::FakeHd*)>("fake_set")(&hardware);
  const SteadyClock clock;
  const device::DeviceName name{"openhaptics", "", {{"library", PALPATE_FAKE_HD}}};
  exchange_all(state, *device::open_openhaptics(name, clock));
}

void exchange_openhaptics_at_1_khz(benchmark::State& state) {
  exchange_openhaptics(state, 1e-3);
}

void exchange_openhaptics_at_once(benchmark::State& state) {
  exchange_openhaptics(state, 0);
}

void exchange_haply(benchmark::State& state) {
  const SteadyClock clock;
  const test::FakeHaplyService service;
  const device::DeviceName name{"haply", "04EA", {{"url", service.url()}}};
  exchange_all(state, *device::open_haply(name, clock));
}

double quantile(const std::vector<double>& sorted, double share) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(share * last)];
}

// A minute of exploring, on the stiffest surface that the simulated device holds, every guard on.
void step(benchmark::State& state, const std::string& cloud) {
  Scene scene;
  scene.add(cloud, synthetic_cloud(cloud));
  ServoOptions options;
  const Placement plan = plan_exploration(scene, options.field, {.duration = 60});
  options.workspace = plan.workspace;
  options.proxy.stiffness = plan.stiffness;
  std::vector<double> times;
  for ([[maybe_unused]] const auto& each : state) {
    SimulatedDevice device({}, plan.target);
    Servo servo(device, scene, options);
    times.clear();
    while (!has_ended(servo.state().device)) {
      const DeviceState hand = device.read();
      const double start = thread_cpu_seconds();
      servo.step(hand, hand.time);
      times.push_back(1e6 * (thread_cpu_seconds() - start));
      servo.write();
      servo.show();
    }
  }
  std::ranges::sort(times);
  for (const auto& [label, share] :
       {std::pair{"p50_us", 0.5}, {"p99_us", 0.99}, {"p99.9_us", 0.999}}) {
    state.counters[label] = quantile(times, share);
  }
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate::bench;
  const auto exchange = [](const char* name, void (*run)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, run)->UseRealTime();
  };
  exchange("exchange/forcedimension", exchange_forcedimension);
  exchange("exchange/openhaptics_at_1_kHz", exchange_openhaptics_at_1_khz);
  exchange("exchange/openhaptics_at_once", exchange_openhaptics_at_once);
  exchange("exchange/haply", exchange_haply);
  for (const palpate::SyntheticName& each : palpate::synthetic_names()) {
    const std::string name(each.name);
    benchmark::RegisterBenchmark(("step/" + name).c_str(),
                                 [name](benchmark::State& state) { step(state, name); })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
