// A run in simulated time.
#include <fmt/format.h>

#include <vector>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/sources/large_cloud.hpp"
#include "apps/palpate/touch/touch.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

namespace {

std::vector<SimulatedStream> make_streams(Run& run) {
  SimulatedStreamOptions options;
  options.latency = run.time.latency.value_or(options.latency);
  std::vector<SimulatedStream> streams;
  for (std::size_t i = 0; i < run.loaded.sources.size(); ++i) {
    LoadedSource& from = run.loaded.sources[i];
    if (!from.camera) continue;
    from.feed.simulated = true;
    Feeding feed = feeding(run.loaded, i, run.recorder);
    streams.emplace_back(*from.camera, run.loaded.scene.source(i).name(), std::move(feed.sink),
                         options, std::move(feed.ended));
  }
  return streams;
}

// Reads all that tools may need, however long that takes: a run repeats bit for bit.
void read_around_tools(Run& run, double time, const Interruption& interruption) {
  for (std::size_t i = 0; i < run.loaded.sources.size(); ++i) {
    OnDemand* const cloud = run.loaded.sources[i].on_demand.get();
    if (cloud == nullptr) continue;
    Source& source = run.loaded.scene.source(i);
    while (!interruption.requested() && advance(*cloud, source, time)) continue;
  }
}

}  // namespace

bool run_simulated(Run& run, const EachStep& each) {
  const Hand& hand = run.hands.front();
  Device& device = *hand.device;
  ServoOptions options = servo_options(run, hand);
  options.guard.on = false;
  Servo servo(device, run.loaded.scene, options);
  if (run.recorder != nullptr) run.recorder->begin(run.loaded, {&servo}, 0, true);
  std::vector<SimulatedStream> streams = make_streams(run);
  const Interruption interruption;
  DeviceState state = device.read();
  for (; state.status != DeviceState::Status::finished; state = device.read()) {
    if (state.status == DeviceState::Status::failed) {
      throw Error(fmt::format("device '{}' failed: {}", device.info().name, device.reason()));
    }
    for (SimulatedStream& stream : streams) stream.advance(state.time);
    read_around_tools(run, state.time, interruption);
    if (interruption.requested()) break;
    const double start = thread_cpu_seconds();
    const ServoState& step = servo.step(state, state.time);
    const double computing = thread_cpu_seconds() - start;
    servo.write();
    servo.show({.computing = computing});
    if (run.recorder != nullptr) run.recorder->keep_up();
    each(0, step);
  }
  std::vector<StreamState> states;
  for (const SimulatedStream& stream : streams) states.push_back(stream.state());
  keep_states(run.loaded, states);
  return !interruption.requested();
}

}  // namespace palpate::app
