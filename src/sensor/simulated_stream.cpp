// Runs a camera and its source in simulated time.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"
#include "sensor/stream_statistics.hpp"

namespace palpate {
namespace sensor {

Stream::Sink sink_of(Source& source) {
  return [&source](const DepthFrame& frame, const Source::StartTime& start) {
    if (source.push(frame, start)) return;
    throw Error(
        fmt::format("all snapshots are held by fields that are not updated, e.g. that of {}. "
                    "Update or close it",
                    source.state().slowest));
  };
}

}  // namespace sensor
namespace {

using namespace sensor;

constexpr double kEver = std::numeric_limits<double>::infinity();

const SimulatedStreamOptions& checked(const SimulatedStreamOptions& options,
                                      const std::string& name) {
  require_time(options.latency >= 0, options.latency, "the latency", name);
  require_time(options.lead >= 0 && options.lead <= options.latency, options.lead, "the lead",
               name);
  require_time(options.stall > 0, options.stall, "the time after which a camera has stalled", name);
  require_time(options.patience >= 0, options.patience, "the wait for a frame", name);
  return options;
}

double frame_time_of(const CameraInfo& camera, const std::string& name) {
  if (camera.paces) {
    throw Error(
        fmt::format("stream to {}: {} runs only in real time. Open it without a clock, or play a "
                    "recording of it.",
                    name, camera.name));
  }
  if (!(camera.rate > 0 && camera.rate < kEver)) {
    throw Error(
        fmt::format("stream to {}: {} reports a rate of {} Hz. Report its nominal frame rate.",
                    name, camera.name, camera.rate));
  }
  return 1 / camera.rate;
}

}  // namespace

// A camera that is polled for frames, and its last answer.
struct PolledCamera {
  DepthCamera& camera;
  DepthFrame frame = {};
  std::string reason = {};  // why the last answer was no frame
  bool silent = false;      // was it none?
  int failures = 0;         // in a row

  DepthCamera::Status look(double patience) {
    const DepthCamera::Status status = try_read(camera, frame, silent ? 0 : patience, reason);
    silent = status == DepthCamera::Status::waiting;
    failures = status == DepthCamera::Status::failed ? failures + 1 : 0;
    return status;
  }
};

struct SimulatedStream::Player {
  Player(DepthCamera& from, const std::string& name, Stream::Sink to,
         const SimulatedStreamOptions& wishes, std::function<void()> at_end)
      : options(checked(wishes, name)),
        frame_time(frame_time_of(from.info(), name)),
        polled{from},
        sink(std::move(to)),
        ended(std::move(at_end)),
        log(name, from.info().name, options.stall, 0),
        check(options.allow_repeats.value_or(from.info().repeats)) {
    from.begin(0);
  }

  void advance(double time);
  void look();
  void schedule();
  void do_without(DepthCamera::Status status);
  void take();
  void prepare();
  void finish();

  const SimulatedStreamOptions options;
  const double frame_time;  // s
  PolledCamera polled;
  const Stream::Sink sink;
  const std::function<void()> ended;  // may be empty
  StreamStatistics log;
  FrameCheck check;
  bool waits = false;      // is there a frame that waits for its time?
  bool over = false;       // none will come any more
  double next = 0;         // when the frame is due, or the camera is polled again, s
  double newest = -kEver;  // when the newest frame so far was due, s
  double now = 0;          // s
};

void SimulatedStream::Player::advance(double time) {
  now = time;
  while (!over && next <= now) {
    if (waits) {
      take();
    } else {
      look();
    }
  }
}

void SimulatedStream::Player::look() {
  if (polled.failures > 0) log.retried();
  const DepthCamera::Status status = polled.look(options.patience);
  waits = status == DepthCamera::Status::frame;
  if (waits) return schedule();
  if (status == DepthCamera::Status::ended) return finish();
  do_without(status);
}

// A stamp that is none, or not after the one before, takes a frame's time: time goes on.
void SimulatedStream::Player::schedule() {
  const double due = polled.frame.stamp + options.latency - options.lead;
  if (due > newest && due < kEver) {
    newest = due;
    next = std::max(next, due);
  } else {
    next += frame_time;
  }
}

void SimulatedStream::Player::do_without(DepthCamera::Status status) {
  if (left_out(status))
    log.frame_received(next, objection_to(status, polled.reason), check.size_changes());
  if (status == DepthCamera::Status::waiting) log.waiting(next, polled.reason);
  if (status == DepthCamera::Status::failed) log.failed(next, polled.reason, polled.failures > 1);
  next += frame_time;
}

void SimulatedStream::Player::take() {
  waits = false;
  const auto objection = check.examine(polled.frame, kEver);
  log.frame_received(next, objection, check.size_changes());
  if (!objection || shows_nothing(polled.frame, *objection)) prepare();
}

void SimulatedStream::Player::prepare() {
  bool shown = false;
  const double start = polled.frame.stamp + options.latency;
  try {
    sink(polled.frame, [&] {
      shown = true;
      return start;
    });
    if (shown) log.touchable(polled.frame.stamp, options.latency);
  } catch (const std::exception& error) {
    log.refused(next, error.what());
  }
}

void SimulatedStream::Player::finish() {
  over = true;
  try {
    if (ended) ended();
  } catch (const std::exception& error) {
    log.refused(next, error.what());
  }
  log.ended();
}

SimulatedStream::SimulatedStream(DepthCamera& camera, const std::string& name, Stream::Sink sink,
                                 const SimulatedStreamOptions& options, std::function<void()> ended)
    : player_(std::make_unique<Player>(camera, name, std::move(sink), options, std::move(ended))) {}

SimulatedStream::SimulatedStream(DepthCamera& camera, Source& source,
                                 const SimulatedStreamOptions& options)
    : SimulatedStream(camera, source.name(), sink_of(source), options,
                      [&source] { source.keep(); }) {}

SimulatedStream::~SimulatedStream() = default;
SimulatedStream::SimulatedStream(SimulatedStream&&) noexcept = default;
SimulatedStream& SimulatedStream::operator=(SimulatedStream&&) noexcept = default;

void SimulatedStream::advance(double now) {
  player_->advance(now);
}

StreamState SimulatedStream::state() const {
  return player_->log.state(player_->now);
}

}  // namespace palpate
