#include "apps/palpate/touch/simulated_run.hpp"

#include <fmt/format.h>

#include <vector>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/run/feed.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/simulated_stream.hpp"

namespace palpate::app {

namespace {

std::vector<SimulatedStream> make_streams(Run& run) {
  SimulatedStreamOptions options;
  options.latency = run.time.latency.value_or(options.latency);
  std::vector<SimulatedStream> streams;
  for (std::size_t i = 0; i < run.felt.size(); ++i) {
    TouchedSource& touched = run.touched.sources[i];
    if (!touched.camera) continue;
    touched.feed.simulated = true;
    Source& felt = run.felt.source(i);
    streams.emplace_back(*touched.camera, felt.name(), feeding(touched, felt, thread_cpu_seconds),
                         options, [&felt] { felt.keep(); });
  }
  return streams;
}

}  // namespace

bool run_simulated(Run& run, const EachStep& each) {
  const Hand& hand = run.hands.front();
  SceneField field(run.felt, run.field, "a field", hand.workspace.scale);
  Proxy proxy(run.proxy);
  std::vector<SimulatedStream> streams = make_streams(run);
  const Interruption interruption;
  const auto see = [&](double time) {
    for (SimulatedStream& stream : streams) stream.advance(time);
    return !interruption.asked();
  };
  run_touch(*hand.device, hand.workspace, field, proxy, see,
            [&](const TouchStep& step) { each(0, step); });
  std::vector<StreamState> states;
  for (const SimulatedStream& stream : streams) states.push_back(stream.state());
  keep_states(run.touched, run.felt, states);
  return !interruption.asked();
}

void run_touch(Device& device, const Workspace& workspace, SceneField& field, Proxy& proxy,
               const std::function<bool(double)>& before,
               const std::function<void(const TouchStep&)>& each) {
  double previous = 0;
  bool first = true;
  while (true) {
    const DeviceState state = device.read();
    if (state.status == DeviceStatus::finished) return;
    if (state.status == DeviceStatus::failed) {
      throw Error(fmt::format("device '{}' failed: {}", device.info().name, device.reason()));
    }
    if (!before(state.time)) return;
    const double dt = first ? 1 / device.info().rate : state.time - previous;
    TouchStep step;
    step.time = state.time;
    step.hip = workspace.position_to_world(state.position);
    const double start = thread_cpu_seconds();
    field.update(state.time, step.hip, first ? step.hip : proxy.position());
    step.contact = proxy.step(field, step.hip, dt);
    step.microseconds = 1e6 * (thread_cpu_seconds() - start);
    step.patch_points = field.patch_points();
    step.notes = field.notes();
    device.write(workspace.force_to_device(step.contact.force));
    each(step);
    previous = state.time;
    first = false;
  }
}

void run_touch(Device& device, const Workspace& workspace, SceneField& field, Proxy& proxy,
               const std::function<void(const TouchStep&)>& each) {
  run_touch(
      device, workspace, field, proxy, [](double) { return true; }, each);
}

}  // namespace palpate::app
