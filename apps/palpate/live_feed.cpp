#include "apps/palpate/live_feed.hpp"

#include <optional>
#include <utility>

#include "palpate/base/thread_clock.hpp"

namespace palpate::app {

// What the sink notes is its thread's until the stream has ended.
struct LiveFeed::Lane {
  Lane(TouchedSource& from, Source& to, const Clock& clock, const StreamOptions& options)
      : touched(from), felt(to) {
    stream.emplace(
        *from.camera, to.name(),
        [this](const DepthFrame& frame, const StartTime& start) { take(frame, start); }, clock,
        options, [this] { felt.keep(); });
  }

  void take(const DepthFrame& frame, const StartTime& start) {
    if (report.prepare_ms.empty()) report.first_stamp = frame.stamp;
    report.last_stamp = frame.stamp;
    report.width = frame.camera.width;
    report.height = frame.camera.height;
    const double begin = thread_cpu_seconds();
    push_frame(touched, felt, frame, start);
    report.prepare_ms.push_back(1e3 * (thread_cpu_seconds() - begin));
  }

  TouchedSource& touched;
  Source& felt;
  FeedReport report;
  std::optional<Stream> stream;
};

LiveFeed::LiveFeed(Touched& touched, Scene& felt, const Clock& clock, double start)
    : touched_(touched), felt_(felt), start_(start) {
  StreamOptions options;
  options.start = start;
  for (std::size_t i = 0; i < touched.sources.size(); ++i) {
    TouchedSource& source = touched.sources[i];
    if (source.camera) lanes_.emplace_back(source, felt.source(i), clock, options);
  }
}

LiveFeed::~LiveFeed() = default;

std::vector<StreamState> LiveFeed::states() const {
  std::vector<StreamState> states;
  for (const Lane& lane : lanes_) states.push_back(lane.stream->state());
  return states;
}

void LiveFeed::finish() {
  for (Lane& lane : lanes_) {
    StreamState state = lane.stream->state();
    lane.stream.reset();
    lane.report.state = std::move(state);
    lane.report.state.problem_at -= start_;
    lane.report.state.last_frame -= start_;
    lane.report.first_stamp -= start_;
    lane.report.last_stamp -= start_;
    lane.touched.feed = lane.report;
  }
  for (std::size_t i = 0; i < felt_.size(); ++i) {
    if (touched_.sources[i].camera) touched_.sources[i].state = felt_.state(i);
  }
}

}  // namespace palpate::app
