// Feeds the sources of a run in real time: streams, and clouds that are prepared on demand.
#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "apps/palpate/run/run.hpp"
#include "apps/palpate/sources/large_cloud.hpp"

namespace palpate::app {

namespace {

// Between looks at where tools are. A hand of 1 m/s goes 5 mm, less than a block; judgement.
constexpr std::chrono::milliseconds kIdle{5};
// s after which a simulated camera has stalled: below it is a busy machine, which is no fault of a
// sensor's; judgement.
constexpr double kSimulatedStall = 1;

}  // namespace

LiveFeed::LiveFeed(LoadedScene& loaded, const Clock& clock, double start, Recorder* recorder)
    : loaded_(loaded), clock_(clock), start_(start) {
  StreamOptions options;
  options.start = start;
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    LoadedSource& from = loaded.sources[i];
    if (from.on_demand) {
      preparing_.emplace_back([this, i](const std::stop_token& stop) { prepare(i, stop); });
    }
    if (!from.camera) continue;
    const bool simulated = from.camera->info().name.starts_with("simulated");
    options.stall = simulated ? kSimulatedStall : StreamOptions().stall;
    Feeding feed = feeding(loaded, i, recorder);
    streams_.emplace_back(*from.camera, loaded.scene.source(i).name(), std::move(feed.sink), clock,
                          options, std::move(feed.ended));
  }
}

void LiveFeed::prepare(std::size_t index, const std::stop_token& stop) {
  OnDemand& cloud = *loaded_.sources[index].on_demand;
  Source& source = loaded_.scene.source(index);
  while (!cloud.done() && !stop.stop_requested()) {
    try {
      if (!cloud.advance(source, clock_.now(), true, stop)) std::this_thread::sleep_for(kIdle);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      problems_.push_back(missing_part(source, error));
    }
  }
}

double LiveFeed::prepared() const {
  double least = 1;
  for (const LoadedSource& source : loaded_.sources) {
    if (source.on_demand) least = std::min(least, source.on_demand->share());
  }
  return least;
}

std::vector<std::string> LiveFeed::problems() const {
  const std::lock_guard lock(mutex_);
  return problems_;
}

std::vector<StreamState> LiveFeed::states() const {
  std::vector<StreamState> states;
  for (const Stream& stream : streams_) states.push_back(stream.state());
  return states;
}

void LiveFeed::finish() {
  std::vector<StreamState> states = this->states();
  streams_.clear();
  preparing_.clear();
  for (std::size_t i = 0; i < loaded_.sources.size(); ++i) {
    LoadedSource& source = loaded_.sources[i];
    if (!source.on_demand) continue;
    const Prepared::Report report = loaded_.scene.source(i).report();
    if (report.points_in > 0) source.prepared = report;  // else nothing came in the run
  }
  for (StreamState& state : states) {
    state.problem_at -= start_;
    state.last_frame -= start_;
  }
  keep_states(loaded_, states);
}

}  // namespace palpate::app
