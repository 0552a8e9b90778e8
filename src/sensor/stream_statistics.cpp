// Counts and judges a stream's frames: rate, latency, drops, and what is wrong with one.
#include "sensor/stream_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <exception>
#include <span>
#include <utility>

namespace palpate::sensor {
namespace {

constexpr int kLasts = 3;  // frames of a new size in a row that are believed: one may be damage

bool is_camera(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return camera.width > 0 && camera.height > 0 && std::isfinite(p.cx) && std::isfinite(p.cy) &&
         std::isfinite(p.fx) && std::isfinite(p.fy) && p.fx != 0 && p.fy != 0;
}

std::optional<Objection> check_form(const DepthFrame& frame) {
  const CameraModel& camera = frame.camera;
  if (!is_camera(camera)) {
    return Objection{
        &StreamState::Drops::garbage,
        fmt::format("a frame of {} x {} pixels and a focal length of {} x {} pixels", camera.width,
                    camera.height, camera.pinhole.fx, camera.pinhole.fy)};
  }
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (frame.depth.size() != pixels || (!frame.colors.empty() && frame.colors.size() != pixels)) {
    return Objection{
        &StreamState::Drops::garbage,
        fmt::format("a frame of {} x {} pixels with {} depths and {} colours", camera.width,
                    camera.height, frame.depth.size(), frame.colors.size())};
  }
  if (frame.T_world_sensor && !frame.T_world_sensor->matrix().allFinite()) {
    return Objection{&StreamState::Drops::garbage, "a frame with a pose that is not finite"};
  }
  return {};
}

bool is_empty(const DepthFrame& frame) {
  if (frame.cloud) return frame.cloud->empty();
  return std::ranges::none_of(frame.depth, [](float z) { return std::isfinite(z) && z > 0; });
}

// A sum that any changed bit changes: multiply and add, over eight lanes so that a frame costs a
// fraction of a millisecond.
std::uint64_t sum_of(std::span<const float> depth) {
  constexpr std::size_t kLanes = 8;
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15ULL;
  std::array<std::uint64_t, kLanes> lanes{};
  const std::size_t whole = depth.size() / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      lanes[k] = lanes[k] * kOdd + std::bit_cast<std::uint32_t>(depth[i + k]) + 1;
    }
  }
  std::uint64_t sum = depth.size();
  for (std::size_t i = whole; i < depth.size(); ++i) {
    sum = sum * kOdd + std::bit_cast<std::uint32_t>(depth[i]) + 1;
  }
  for (const std::uint64_t lane : lanes) sum = (sum ^ (sum >> 29U)) * kOdd + lane;
  return sum;
}

}  // namespace

bool left_out(DepthCamera::Status status) noexcept {
  return status == DepthCamera::Status::damaged || status == DepthCamera::Status::unposed;
}

Objection objection_to(DepthCamera::Status status, const std::string& reason) {
  const bool unposed = status == DepthCamera::Status::unposed;
  const std::string words = unposed ? "a frame without a pose" : "a damaged frame";
  return {unposed ? &StreamState::Drops::unposed : &StreamState::Drops::garbage,
          reason.empty() ? words : reason};
}

std::optional<Objection> FrameCheck::examine(const DepthFrame& frame, double latest) {
  if (auto objection = check_form(frame); objection && !frame.cloud) return objection;
  if (auto objection = check_stamp(frame.stamp, latest)) return objection;
  if (auto objection = frame.cloud ? std::nullopt : check_size(frame)) return objection;
  stamp_ = frame.stamp;
  if (auto objection = check_picture(frame)) return objection;
  return {};
}

std::optional<Objection> FrameCheck::check_stamp(double stamp, double latest) const {
  if (!std::isfinite(stamp) || stamp > latest) {
    return Objection{&StreamState::Drops::late,
                     fmt::format("a frame taken at {} s, which is {}", stamp,
                                 stamp > latest ? "in the future: is the camera on another clock?"
                                                : "not a valid time")};
  }
  if (stamp_ && stamp <= *stamp_) {
    return Objection{
        &StreamState::Drops::late,
        fmt::format("a frame taken at {:.6f} s, not later than the previous one at {:.6f} s", stamp,
                    *stamp_)};
  }
  return {};
}

std::optional<Objection> FrameCheck::check_size(const DepthFrame& frame) {
  const Size size{frame.camera.width, frame.camera.height};
  if (size_ == Size{}) size_ = size;
  if (size == size_) {
    candidate_seen_ = 0;
    return {};
  }
  candidate_seen_ = size == candidate_ ? candidate_seen_ + 1 : 1;
  candidate_ = size;
  if (candidate_seen_ < kLasts) {
    return Objection{&StreamState::Drops::resized,
                     fmt::format("a frame of {} x {} pixels after those of {} x {}", size.width,
                                 size.height, size_.width, size_.height)};
  }
  size_ = size;
  candidate_seen_ = 0;
  ++size_changes_;
  return {};
}

std::optional<Objection> FrameCheck::check_picture(const DepthFrame& frame) {
  if (is_empty(frame)) {
    return Objection{
        &StreamState::Drops::empty,
        "a frame without any depth or point: is the lens covered, or everything out of range?"};
  }
  if (allow_repeats_ || frame.cloud) return {};
  const std::uint64_t picture = sum_of(frame.depth);
  if (picture_ == picture) {
    return Objection{&StreamState::Drops::repeated, "a frame identical to the previous one"};
  }
  picture_ = picture;
  return {};
}

}  // namespace palpate::sensor

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

DepthCamera::Status try_read(DepthCamera& camera, DepthFrame& frame, double timeout,
                             std::string& reason) {
  try {
    const DepthCamera::Status status = camera.read(frame, timeout);
    if (status != DepthCamera::Status::frame) reason = camera.reason();
    return status;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  return DepthCamera::Status::failed;
}

StreamStatistics::StreamStatistics(std::string source, std::string camera, double stall, double now)
    : stall_(stall), useful_(now) {
  state_.source = std::move(source);
  state_.camera = std::move(camera);
  state_.last_frame = now;
}

void StreamStatistics::frame_received(double now, const std::optional<Objection>& objection,
                                      std::uint64_t size_changes) {
  // The rate is a mean over at least so many intervals and so long, as frames may come in bunches.
  constexpr std::size_t kIntervals = 8;
  constexpr double kTime = 1;  // s
  const std::lock_guard lock(mutex_);
  failing_ = false;
  look(now);
  arrivals_.push_back(now);
  while (arrivals_.size() > kIntervals + 1 && now - arrivals_[1] >= kTime) {
    arrivals_.pop_front();
  }
  ++state_.frames;
  state_.last_frame = now;
  objection_ = objection ? objection->words : "";
  reason_.clear();
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
  counted_ = false;
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

void StreamStatistics::touchable(double stamp, double latency) {
  const std::lock_guard lock(mutex_);
  stamp_ = stamp;
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

void StreamStatistics::waiting(double now, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  failing_ = false;
  reason_ = reason.empty() ? "" : ": " + reason;
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
  if (std::exchange(counted_, true)) return;
  ++state_.stalls;
  const std::string_view kind = objection_.empty() ? "" : "usable ";
  const std::string why = !objection_.empty() ? "; the last: " + objection_ : reason_;
  note(now, fmt::format("no {}frame for {:.3g} s{}", kind, now - useful_, why));
}

void StreamStatistics::note(double now, const std::string& what) {
  state_.problem = fmt::format("{} ({}): {}", state_.source, state_.camera, what);
  state_.problem_at = now;
}

StreamState StreamStatistics::state(double now) {
  const std::lock_guard lock(mutex_);
  look(now);
  StreamState state = state_;
  if (state.touchable > 0) state.age = now - stamp_;
  const double intervals = static_cast<double>(arrivals_.size()) - 1;
  const double mean = intervals > 0 ? (arrivals_.back() - arrivals_.front()) / intervals : 0;
  const bool over = state.phase == StreamState::Phase::ended;
  const double interval = over ? mean : std::max(mean, now - state_.last_frame);
  state.rate = state_.frames > 1 && interval > 0 ? 1 / interval : 0;
  return state;
}

}  // namespace palpate::sensor
