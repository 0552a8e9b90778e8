#include "apps/palpate/run/live_feed.hpp"

#include "apps/palpate/run/feeding.hpp"
#include "palpate/base/clock.hpp"

namespace palpate::app {

LiveFeed::LiveFeed(Touched& touched, Scene& felt, const Clock& clock, double start)
    : touched_(touched), felt_(felt), start_(start) {
  StreamOptions options;
  options.start = start;
  for (std::size_t i = 0; i < touched.sources.size(); ++i) {
    TouchedSource& from = touched.sources[i];
    if (!from.camera) continue;
    Source& to = felt.source(i);
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
  keep_states(touched_, felt_, states);
}

}  // namespace palpate::app
