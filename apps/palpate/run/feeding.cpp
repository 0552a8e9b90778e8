#include "apps/palpate/run/feeding.hpp"

namespace palpate::app {

FrameSink feeding(TouchedSource& touched, Source& felt, double (*computing)()) {
  return [&touched, &felt, computing](const DepthFrame& frame, const StartTime& start) {
    FeedReport& feed = touched.feed;
    feed.width = frame.camera.width;
    feed.height = frame.camera.height;
    const double begin = computing();
    push_frame(touched, felt, frame, start);
    feed.prepare_ms.push_back(1e3 * (computing() - begin));
  };
}

void keep_states(Touched& touched, const Scene& felt, const std::vector<StreamState>& states) {
  auto next = states.begin();
  for (std::size_t i = 0; i < felt.size(); ++i) {
    TouchedSource& source = touched.sources[i];
    if (!source.camera) continue;
    source.feed.state = *next++;
    source.state = felt.state(i);
  }
}

}  // namespace palpate::app
