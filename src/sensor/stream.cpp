// The threads of a stream: one reads the camera, one prepares the newest frame.
#include "palpate/sensor/stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "palpate/base/error.hpp"
#include "sensor/camera_clock.hpp"
#include "sensor/frame_exchange.hpp"
#include "sensor/stream_statistics.hpp"

namespace palpate {
namespace sensor {

// Chooses the wait before a failed camera is read again: none after one failure, then ever longer.
class Retry {
 public:
  Retry(double first, double longest) : first_(first), longest_(longest) {}

  void succeeded() { failures_ = 0; }

  // Another failure; s to wait.
  [[nodiscard]] double failed() {
    ++failures_;
    if (failures_ == 1) return 0;
    wait_ = failures_ == 2 ? first_ : std::min(2 * wait_, longest_);
    return wait_;
  }

  // More than one failure in a row.
  [[nodiscard]] bool repeatedly() const { return failures_ > 1; }

 private:
  double first_;
  double longest_;
  double wait_ = 0;
  int failures_ = 0;  // in a row
};

}  // namespace sensor
namespace {

using namespace sensor;

// No frame takes so long to arrive: a first one that seems to have done so has another
// clock's stamp.
constexpr double kOtherClock = 30;  // s (judgement)

// Work left after preparation requested a start is predicted from the longest so far, which decays
// by kForget a frame and is capped at kLongestTail, so that one hiccup costs little (judgement).
constexpr double kForget = 0.9;
constexpr double kLongestTail = 0.02;  // s

const StreamOptions& checked(const StreamOptions& options, const std::string& name) {
  const auto require = [&](bool good, double seconds, const char* what) {
    require_time(good, seconds, what, name);
  };
  require(options.lead >= 0, options.lead, "the lead");
  require(options.stall > 0, options.stall, "the time after which a camera has stalled");
  require(options.patience > 0, options.patience, "the wait for a frame");
  require(options.first_retry > 0, options.first_retry, "the wait before a retry");
  require(options.longest_retry >= options.first_retry, options.longest_retry,
          "the longest wait before a retry");
  if (options.start) require(true, *options.start, "the start");
  return options;
}

}  // namespace

// What the preparing thread does: passes frames on, and predicts how long that takes.
struct Preparation {
  const Stream::Sink sink;
  const std::function<void()> ended;  // may be empty
  const double lead;                  // s
  const Clock& clock;
  StreamStatistics& log;
  double tail = 0;  // s from requesting a start to the end, recent

  void run(FrameExchange& exchange);
  void prepare(const DepthFrame& frame);
  void finish();
};

struct Stream::Threads {
  Threads(DepthCamera& from, const std::string& name, Stream::Sink to, const Clock& time,
          const StreamOptions& wishes, std::function<void()> at_end)
      : options(checked(wishes, name)),
        camera(from),
        clock(time),
        log(name, camera.info().name, options.stall, clock.now()),
        check(options.allow_repeats.value_or(camera.info().repeats)),
        retry(options.first_retry, options.longest_retry),
        exchange(!camera.info().paces),
        preparation{std::move(to), std::move(at_end), options.lead, clock, log} {
    camera.begin(options.start.value_or(clock.now()));
    start(name);
  }

  ~Threads() { stop(); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  void start(const std::string& name);
  void stop();
  void read();
  [[nodiscard]] bool take(DepthFrame& frame);
  void leave_out(DepthCamera::Status status);
  void compare_clocks(double stamp, double now);
  void bring_to_clock(DepthFrame& frame, double now);
  [[nodiscard]] bool wait_to_retry();

  const StreamOptions options;
  DepthCamera& camera;  // the reading thread's
  const Clock& clock;
  StreamStatistics log;
  FrameCheck check;    // the reading thread's
  CameraClock stamps;  // the reading thread's
  Retry retry;         // the reading thread's
  FrameExchange exchange;
  std::string reason;       // why the last answer was no frame; the reading thread's
  Preparation preparation;  // the preparing thread's
  std::thread preparing;
  std::thread reading;
};

void Stream::Threads::start(const std::string& name) {
  try {
    preparing = std::thread([this] { preparation.run(exchange); });
    reading = std::thread([this] { read(); });
  } catch (const std::system_error& error) {
    stop();
    throw Error(
        fmt::format("stream to {}: its threads cannot start ({}). Close other programs or raise "
                    "the limit (ulimit -u).",
                    name, error.what()));
  }
}

void Stream::Threads::stop() {
  exchange.stop();
  if (reading.joinable()) reading.join();
  if (preparing.joinable()) preparing.join();
}

void Stream::Threads::read() {
  DepthFrame frame;
  while (exchange.wait_for_room()) {
    const DepthCamera::Status status = try_read(camera, frame, options.patience, reason);
    if (status == DepthCamera::Status::waiting) log.waiting(clock.now(), reason);
    if (left_out(status)) leave_out(status);
    if (status == DepthCamera::Status::ended) break;
    if (status == DepthCamera::Status::frame && !take(frame)) return;
    if (status == DepthCamera::Status::failed && !wait_to_retry()) return;
  }
  exchange.end();
}

bool Stream::Threads::take(DepthFrame& frame) {
  retry.succeeded();
  const double now = clock.now();
  const bool paces = camera.info().paces;
  if (paces) bring_to_clock(frame, now);
  const double latest = paces ? now + kAhead : std::numeric_limits<double>::infinity();
  const auto objection = check.examine(frame, latest);
  log.frame_received(now, objection, check.size_changes());
  if (objection && !sensor::shows_nothing(frame, *objection)) return true;
  const auto outcome = exchange.offer(frame);
  if (outcome == FrameExchange::Offer::overtook) log.overtaken();
  return outcome != FrameExchange::Offer::stopped;
}

// A device that sends damaged frames is there: it is read again at once.
void Stream::Threads::leave_out(DepthCamera::Status status) {
  retry.succeeded();
  log.frame_received(clock.now(), objection_to(status, reason), check.size_changes());
}

void Stream::Threads::compare_clocks(double stamp, double now) {
  if (!(std::abs(stamp - now) > kOtherClock)) return;
  log.warning(now, fmt::format("the camera uses another clock: its first frame was taken at {:.6g} "
                               "s, but it is {:.6g} s now. Open it with the stream's clock",
                               stamp, now));
}

void Stream::Threads::bring_to_clock(DepthFrame& frame, double now) {
  if (stamps.is_new()) compare_clocks(frame.stamp, now);
  frame.stamp = stamps.on_stream(frame.stamp, now);
  const double back = stamps.set_back();
  if (back == 0) return;
  log.warning(now,
              fmt::format("its clock was set {} by {:.3f} s: frames count from when they come, "
                          "less what the quickest one took",
                          back > 0 ? "back" : "forward", std::abs(back)));
}

bool Stream::Threads::wait_to_retry() {
  const double now = clock.now();
  const double until = now + retry.failed();
  log.failed(now, reason, retry.repeatedly());
  while (clock.now() < until) {
    if (!exchange.pause(options.patience)) return false;
  }
  log.retried();
  return true;
}

void Preparation::run(FrameExchange& exchange) {
  DepthFrame frame;
  while (exchange.take(frame)) prepare(frame);
  if (exchange.ended()) finish();
}

void Preparation::finish() {
  try {
    if (ended) ended();
  } catch (const std::exception& error) {
    log.refused(clock.now(), error.what());
  }
  log.ended();
}

void Preparation::prepare(const DepthFrame& frame) {
  std::optional<double> requested;
  const Source::StartTime request_start = [&] {
    requested = clock.now();
    return *requested + tail + lead;
  };
  try {
    const double ahead = tail + lead;
    sink(frame, request_start);
    if (!requested) return;
    const double now = clock.now();
    log.touchable(frame.stamp, std::max(*requested + ahead, now) - frame.stamp);
    tail = std::min(std::max(kForget * tail, now - *requested), kLongestTail);
  } catch (const std::exception& error) {
    log.refused(clock.now(), error.what());
  }
}

Stream::Stream(DepthCamera& camera, const std::string& name, Stream::Sink sink, const Clock& clock,
               const StreamOptions& options, std::function<void()> ended)
    : threads_(std::make_unique<Threads>(camera, name, std::move(sink), clock, options,
                                         std::move(ended))) {}

Stream::Stream(DepthCamera& camera, Source& source, const Clock& clock,
               const StreamOptions& options)
    : Stream(camera, source.name(), sink_of(source), clock, options, [&source] { source.keep(); }) {
}

Stream::~Stream() = default;
Stream::Stream(Stream&&) noexcept = default;
Stream& Stream::operator=(Stream&&) noexcept = default;

StreamState Stream::state() const {
  return threads_->log.state(threads_->clock.now());
}

}  // namespace palpate
