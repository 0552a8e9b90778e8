#include "sensor/stream_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "palpate/sensor/stream.hpp"
#include "sensor/frame_check.hpp"

namespace palpate {

std::string_view name_of(StreamState::Phase phase) noexcept {
  switch (phase) {
    case StreamState::Phase::starting:
      return "starting";
    case StreamState::Phase::running:
      return "running";
    case StreamState::Phase::stalled:
      return "stalled";
    case StreamState::Phase::failed:
      return "failed";
    case StreamState::Phase::ended:
      break;
  }
  return "ended";
}

}  // namespace palpate

namespace palpate::sensor {

CameraStatus ask(DepthCamera& camera, DepthFrame& frame, double timeout, std::string& reason) {
  try {
    const CameraStatus status = camera.read(frame, timeout);
    if (left_out(status) || status == CameraStatus::failed) reason = camera.reason();
    return status;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  return CameraStatus::failed;
}

namespace {

constexpr std::uint64_t kMean = 8;  // intervals that the rate is a mean of, about

}  // namespace

StreamStatistics::StreamStatistics(std::string source, std::string camera, double stall, double now)
    : stall_(stall), useful_(now) {
  state_.source = std::move(source);
  state_.camera = std::move(camera);
  state_.last_frame = now;
}

void StreamStatistics::frame_received(double now, const std::optional<Objection>& objection,
                                      std::uint64_t size_changes) {
  const std::lock_guard lock(mutex_);
  failing_ = false;
  look(now);
  const double interval = now - state_.last_frame;
  if (state_.frames > 0) {
    interval_ += (interval - interval_) / static_cast<double>(std::min(state_.frames, kMean));
  }
  ++state_.frames;
  state_.last_frame = now;
  objection_ = objection ? objection->words : "";
  if (size_changes != state_.size_changes) {
    state_.size_changes = size_changes;
    note(now, "its frame size changed");
  }
  if (objection) {
    ++(state_.drops.*(objection->cause));
    note(now, objection->words);
    look(now);
    return;
  }
  useful_ = now;
  told_ = false;
  state_.phase = StreamState::Phase::running;
}

void StreamStatistics::overtaken() {
  const std::lock_guard lock(mutex_);
  ++state_.drops.overtaken;
}

void StreamStatistics::refused(double now, const std::string& why) {
  const std::lock_guard lock(mutex_);
  ++state_.drops.refused;
  note(now, "a frame could not be prepared: " + why);
}

void StreamStatistics::touchable(double latency) {
  const std::lock_guard lock(mutex_);
  ++state_.touchable;
  ++latencies_;
  latency_sum_ += latency;
  state_.latency_mean = latency_sum_ / static_cast<double>(latencies_);
  state_.latency_worst = latencies_ == 1 ? latency : std::max(state_.latency_worst, latency);
}

void StreamStatistics::failed(double now, const std::string& why, bool repeatedly) {
  const std::lock_guard lock(mutex_);
  ++state_.failures;
  failing_ = repeatedly;
  if (repeatedly) state_.phase = StreamState::Phase::failed;
  note(now, why.empty() ? "it failed without giving a reason" : why);
}

void StreamStatistics::retried() {
  const std::lock_guard lock(mutex_);
  ++state_.retries;
}

void StreamStatistics::ended() {
  const std::lock_guard lock(mutex_);
  state_.phase = StreamState::Phase::ended;
}

void StreamStatistics::waiting(double now) {
  const std::lock_guard lock(mutex_);
  failing_ = false;
  look(now);
}

void StreamStatistics::warning(double now, const std::string& what) {
  const std::lock_guard lock(mutex_);
  note(now, what);
}

void StreamStatistics::look(double now) {
  const bool over =
      state_.phase == StreamState::Phase::stalled || state_.phase == StreamState::Phase::ended;
  if (over || failing_ || now - useful_ <= stall_) return;
  state_.phase = StreamState::Phase::stalled;
  if (std::exchange(told_, true)) return;
  ++state_.stalls;
  note(now, objection_.empty() ? fmt::format("no frame for {:.3g} s", now - useful_)
                               : fmt::format("no usable frame for {:.3g} s; the last: {}",
                                             now - useful_, objection_));
}

void StreamStatistics::note(double now, const std::string& what) {
  state_.problem = fmt::format("{} ({}): {}", state_.source, state_.camera, what);
  state_.problem_at = now;
}

StreamState StreamStatistics::state(double now) {
  const std::lock_guard lock(mutex_);
  look(now);
  StreamState state = state_;
  const bool over = state_.phase == StreamState::Phase::ended;
  const double interval = over ? interval_ : std::max(interval_, now - state_.last_frame);
  state.rate = state_.frames > 1 && interval > 0 ? 1 / interval : 0;
  return state;
}

}  // namespace palpate::sensor
