#include "apps/palpate/run/feed.hpp"

#include "palpate/base/clock.hpp"

namespace palpate::app {

FrameSink feeding(LoadedSource& from, Source& to, double (*computing)()) {
  return [&from, &to, computing](const DepthFrame& frame, const Source::StartTime& start) {
    FeedReport& feed = from.feed;
    feed.width = frame.camera.width;
    feed.height = frame.camera.height;
    const double begin = computing();
    push_frame(from, to, frame, start);
    feed.prepare_ms.push_back(1e3 * (computing() - begin));
  };
}

void keep_states(LoadedScene& loaded, const std::vector<StreamState>& states) {
  auto next = states.begin();
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    LoadedSource& source = loaded.sources[i];
    if (!source.camera) continue;
    source.feed.state = *next++;
    source.state = loaded.scene.state(i);
  }
}

LiveFeed::LiveFeed(LoadedScene& loaded, const Clock& clock, double start)
    : loaded_(loaded), start_(start) {
  StreamOptions options;
  options.start = start;
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    LoadedSource& from = loaded.sources[i];
    if (!from.camera) continue;
    Source& to = loaded.scene.source(i);
    streams_.emplace_back(*from.camera, to.name(), feeding(from, to, thread_cpu_seconds), clock,
                          options, [&to] { to.keep(); });
  }
}

std::vector<StreamState> LiveFeed::states() const {
  std::vector<StreamState> states;
  for (const Stream& stream : streams_) states.push_back(stream.state());
  return states;
}

void LiveFeed::finish() {
  std::vector<StreamState> states = this->states();
  streams_.clear();
  for (StreamState& state : states) {
    state.problem_at -= start_;
    state.last_frame -= start_;
  }
  keep_states(loaded_, states);
}

}  // namespace palpate::app
