#pragma once

#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <string>

#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"
#include "sensor/frame_check.hpp"

namespace palpate::sensor {

/// @throws Error unless an option's time is finite and `good`; `name` is whom the stream feeds.
inline void require_time(bool good, double seconds, const char* what, const std::string& name) {
  if (good && std::isfinite(seconds)) return;
  throw Error(
      fmt::format("stream to {}: {} cannot be {} s. Give a time in seconds.", name, what, seconds));
}

/// DepthCamera::read() of a camera that may also throw: it has failed then. `reason` says why where
/// no whole frame came, and is left as it is otherwise.
[[nodiscard]] CameraStatus ask(DepthCamera& camera, DepthFrame& frame, double timeout,
                               std::string& reason);

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
  void touchable(double latency);
  void failed(double now, const std::string& why, bool repeatedly);
  /// The camera is well and has no frame yet.
  void waiting(double now);
  /// To be told, though nothing is dropped for it.
  void warning(double now, const std::string& what);
  void retried();
  void ended();

  /// How the stream fares at `now`. Notices silence, also that of a camera that never answers.
  [[nodiscard]] StreamState state(double now);

 private:
  void note(double now, const std::string& what);
  void look(double now);

  std::mutex mutex_;
  StreamState state_;
  double stall_;
  double useful_;         // when the last frame of use came, or the stream began
  bool failing_ = false;  // the camera's last answer was that it cannot
  bool told_ = false;     // the stall since the last frame of use is counted
  double interval_ = 0;   // mean time between frames
  double latency_sum_ = 0;
  std::uint64_t latencies_ = 0;
  std::string objection_;  // to the last frame; empty: none
};

}  // namespace palpate::sensor
