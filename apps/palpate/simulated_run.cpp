#include "apps/palpate/run.hpp"
#include "apps/palpate/touch_run.hpp"

namespace palpate::app {

namespace {

constexpr double kLatency = 0.01;  // from stamp to touchable, s

void keep_reports(Run& run, const SimulatedFeed& feed) {
  std::vector<FeedReport> reports = feed.reports();
  auto next = reports.begin();
  for (std::size_t i = 0; i < run.felt.size(); ++i) {
    TouchedSource& source = run.touched.sources[i];
    if (!source.camera) continue;
    source.feed = std::move(*next++);
    source.state = run.felt.state(i);
  }
}

}  // namespace

void run_simulated(Run& run, const EachStep& each) {
  SceneField field(run.felt, run.field);
  Proxy proxy(run.proxy);
  SimulatedFeed feed = make_feed(run.touched, run.felt, run.options.latency.value_or(kLatency));
  run_touch(
      *run.hand.device, run.hand.workspace, field, proxy, [&](double time) { feed.advance(time); },
      each);
  keep_reports(run, feed);
}

}  // namespace palpate::app
