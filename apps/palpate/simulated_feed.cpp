#include "apps/palpate/simulated_feed.hpp"

#include <algorithm>
#include <limits>

#include "apps/palpate/computing_time.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

// So many bad answers in a row are a camera that is out of order: simulated time cannot wait.
constexpr int kPatience = 100;

}  // namespace

SimulatedFeed::SimulatedFeed(std::vector<Feeding> cameras, double latency)
    : latency_(latency), start_(std::numeric_limits<double>::infinity()) {
  for (Feeding& each : cameras) {
    start_ = std::min(start_, each.first.stamp);
    Lane lane;
    lane.camera = each.camera;
    lane.next = std::move(each.first);
    lane.sink = std::move(each.sink);
    lane.ended = std::move(each.ended);
    lane.report.state.source = each.source;
    lane.report.state.camera = each.camera->info().name;
    lanes_.push_back(std::move(lane));
  }
  for (Lane& lane : lanes_) {
    lane.next.stamp -= start_;
    lane.report.first_stamp = lane.next.stamp;
  }
}

SimulatedFeed::Lane* SimulatedFeed::earliest() {
  Lane* result = nullptr;
  for (Lane& lane : lanes_) {
    if (lane.pending && (result == nullptr || lane.next.stamp < result->next.stamp)) result = &lane;
  }
  return result;
}

void SimulatedFeed::advance(double now) {
  while (Lane* lane = earliest()) {
    if (lane->next.stamp + latency_ > now) return;
    push(*lane);
    read_next(*lane);
  }
}

void SimulatedFeed::push(Lane& lane) {
  FeedReport& report = lane.report;
  const double touchable = lane.next.stamp + latency_;
  const double begin = computing_seconds();
  ++report.state.frames;
  try {
    lane.sink(lane.next, [touchable] { return touchable; });
    ++report.state.touchable;
    report.width = lane.next.camera.width;
    report.height = lane.next.camera.height;
  } catch (const Error& error) {
    ++report.state.drops.refused;
    report.state.problem = error.what();
    report.state.problem_at = touchable;
  }
  report.prepare_ms.push_back(1e3 * (computing_seconds() - begin));
  report.last_stamp = lane.next.stamp;
  report.state.last_frame = lane.next.stamp;
}

void SimulatedFeed::read_next(Lane& lane) {
  StreamState& state = lane.report.state;
  for (int tries = 0; tries < kPatience; ++tries) {
    const CameraStatus status = lane.camera->read(lane.next, 0);
    if (status == CameraStatus::frame) {
      lane.next.stamp -= start_;
      if (lane.next.stamp > state.last_frame) return;
      ++state.frames;
      ++state.drops.late;
      continue;
    }
    if (status == CameraStatus::ended) {
      state.phase = StreamPhase::ended;
      lane.pending = false;
      lane.ended();
      return;
    }
    if (status == CameraStatus::damaged || status == CameraStatus::failed) {
      ++state.failures;
      state.problem = lane.camera->reason();
    } else {
      ++state.stalls;
      state.problem = "no frame came";
    }
    state.problem_at = state.last_frame;
  }
  state.phase = StreamPhase::failed;
  lane.pending = false;
}

std::vector<FeedReport> SimulatedFeed::reports() const {
  std::vector<FeedReport> reports;
  for (const Lane& lane : lanes_) {
    FeedReport report = lane.report;
    const double span = report.last_stamp - report.first_stamp;
    const auto intervals = static_cast<double>(report.prepare_ms.size()) - 1;
    if (span > 0) report.state.rate = intervals / span;
    if (!report.prepare_ms.empty()) {
      report.state.latency_mean = latency_;
      report.state.latency_worst = latency_;
      if (report.state.phase == StreamPhase::starting) report.state.phase = StreamPhase::running;
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace palpate::app
