#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::sensor {

/// Why a frame is not passed on.
struct Objection {
  std::uint64_t StreamState::Drops::*cause;
  std::string words;
};

/// Does the camera itself leave a frame out that came?
[[nodiscard]] bool left_out(DepthCamera::Status status) noexcept;

/// The objection to such a frame, for the camera's reason.
[[nodiscard]] Objection objection_to(DepthCamera::Status status, const std::string& reason);

/// Is it an image that measures nothing, and has no other fault? It makes no surface, but its
/// source is told that nothing is seen.
[[nodiscard]] inline bool shows_nothing(const DepthFrame& frame,
                                        const Objection& objection) noexcept {
  return objection.cause == &StreamState::Drops::empty && !frame.cloud;
}

/// Looks at the frames of one camera, in the order in which they come.
class FrameCheck {
 public:
  explicit FrameCheck(bool allow_repeats) : allow_repeats_(allow_repeats) {}

  /// Nothing when the frame is good. No stamp can lie after `latest`, s.
  [[nodiscard]] std::optional<Objection> examine(const DepthFrame& frame, double latest);

  /// New sizes that lasted.
  [[nodiscard]] std::uint64_t size_changes() const { return size_changes_; }

 private:
  [[nodiscard]] std::optional<Objection> check_stamp(double stamp, double latest) const;
  [[nodiscard]] std::optional<Objection> check_size(const DepthFrame& frame);
  [[nodiscard]] std::optional<Objection> check_picture(const DepthFrame& frame);

  struct Size {
    int width = 0;
    int height = 0;
    bool operator==(const Size&) const = default;
  };

  bool allow_repeats_;
  Size size_;               // of frames that are passed on
  Size candidate_;          // another one that came lately
  int candidate_seen_ = 0;  // times in a row
  std::uint64_t size_changes_ = 0;
  std::optional<double> stamp_;           // of the last frame that was passed on
  std::optional<std::uint64_t> picture_;  // sum over its depths
};

/// @throws Error unless an option's time is finite and `good`; `name` is whom the stream feeds.
inline void require_time(bool good, double seconds, const char* what, const std::string& name) {
  if (good && std::isfinite(seconds)) return;
  throw Error(
      fmt::format("stream to {}: {} cannot be {} s. Give a time in seconds.", name, what, seconds));
}

/// DepthCamera::read() of a camera that may also throw: it has failed then. `reason` states why
/// where no whole frame came, if the camera reports it, and is left as it is otherwise.
[[nodiscard]] DepthCamera::Status try_read(DepthCamera& camera, DepthFrame& frame, double timeout,
                                           std::string& reason);

/// Pushes into `source`, which outlives it. Throws Error when no snapshot is free.
[[nodiscard]] Stream::Sink sink_of(Source& source);

/// Keeps a stream's books. Any thread; times are s on the stream's clock.
class StreamStatistics {
 public:
  StreamStatistics(std::string source, std::string camera, double stall, double now);

  /// A frame came from the camera; one of use if nothing objects to it.
  void frame_received(double now, const std::optional<Objection>& objection,
                      std::uint64_t size_changes);
  void overtaken();
  /// Preparation of a frame threw.
  void refused(double now, const std::string& why);
  /// `stamp`: of the frame, s.
  void touchable(double stamp, double latency);
  void failed(double now, const std::string& why, bool repeatedly);
  /// The camera is well and has no frame yet; `reason` states why, or is empty.
  void waiting(double now, const std::string& reason);
  /// Notes a warning without a dropped frame.
  void warning(double now, const std::string& what);
  void retried();
  void ended();

  /// State of the stream at `now`. Notices silence, also that of a camera that never answers.
  [[nodiscard]] StreamState state(double now);

 private:
  void note(double now, const std::string& what);
  void look(double now);

  std::mutex mutex_;
  StreamState state_;
  double stall_;
  double useful_;                // when the last frame of use came, or the stream began
  bool failing_ = false;         // the camera's last answer was that it cannot
  bool counted_ = false;         // the stall since the last frame of use is counted
  std::deque<double> arrivals_;  // of the last frames, s
  double stamp_ = 0;             // of the last frame that became touchable, s
  double latency_sum_ = 0;
  std::uint64_t latencies_ = 0;
  std::string objection_;  // to the last frame; empty: none
  std::string reason_;     // ": " and why there is no frame since then; empty: unknown
};

}  // namespace palpate::sensor
