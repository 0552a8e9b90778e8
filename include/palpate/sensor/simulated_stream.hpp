#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "palpate/scene/source.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate {

struct SimulatedStreamOptions {
  double latency = 0.01;  ///< a surface is felt from so long after its frame's stamp on, s
  double lead = 0;        ///< and is ready so long before, s; the latency at most
  double stall = 0.5;     ///< as StreamOptions has it, s
  double patience = 1;    ///< a camera may keep the host waiting so long, s; one that did is not
                          ///< waited for any more until it answers
  std::optional<bool> allow_repeats = {};  ///< as StreamOptions has it
};

/// A Stream in simulated time: the same looks at frames and the same books, but one thread and no
/// clock. The camera begins at t = 0; each frame is prepared when simulated time comes to its stamp
/// plus latency less lead, so that nothing is overtaken and the same camera gives the same
/// surfaces, bit for bit.
///
/// A camera that has no frame, or none that comes after the one before, is asked again one frame's
/// time later: it is not given up, and does not hold up time either.
class SimulatedStream {
 public:
  /// Lets the camera begin. Camera and source outlive the stream, and nobody else reads or pushes.
  /// @throws Error when an option is out of range, when the camera keeps its own time
  /// (CameraInfo::paces) or gives no rate, or cannot begin.
  SimulatedStream(DepthCamera& camera, Source& source, const SimulatedStreamOptions& options = {});

  /// The same into any sink; `name` stands for it in messages. `ended`, if any, is called after the
  /// last frame of a recording.
  SimulatedStream(DepthCamera& camera, const std::string& name, FrameSink sink,
                  const SimulatedStreamOptions& options = {}, std::function<void()> ended = {});

  ~SimulatedStream();
  SimulatedStream(SimulatedStream&&) noexcept;
  SimulatedStream& operator=(SimulatedStream&&) noexcept;

  /// Prepares what is ready by `now` (s, never less than before). Calls the sink; may allocate.
  void advance(double now);

  /// Its state, in simulated time.
  [[nodiscard]] StreamState state() const;

 private:
  struct Player;
  std::unique_ptr<Player> player_;
};

}  // namespace palpate
