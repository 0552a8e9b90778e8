#include <vector>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/run/feeding.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/touch/touch_run.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/sensor/simulated_stream.hpp"

namespace palpate::app {

namespace {

std::vector<SimulatedStream> make_streams(Run& run) {
  SimulatedStreamOptions options;
  options.latency = run.options.latency.value_or(options.latency);
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

}  // namespace palpate::app
