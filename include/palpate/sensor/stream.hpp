#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "palpate/base/clock.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream_state.hpp"

namespace palpate {

struct StreamOptions {
  double lead = 2e-3;      ///< a surface is felt from so long after it is ready, as far as that can
                           ///< be foreseen, s
  double stall = 0.5;      ///< a camera silent or frozen for longer has stalled, s
  double patience = 0.05;  ///< one DepthCamera::read() may wait so long, s; so may the destructor
  double first_retry = 0.25;  ///< the second failure in a row waits so long, s; then twice, ...
  double longest_retry = 5;   ///< ... but no longer than this, s
  /// When a recording begins (DepthCamera::begin), s on the clock; streams that are given one start
  /// play recordings in step. Unset: as soon as the stream is there.
  std::optional<double> start = {};
  /// Frames that repeat the one before bit for bit are real. Otherwise they are dropped, so that a
  /// frozen camera's surface fades as a silent one's does. Unset: as CameraInfo::repeats says.
  std::optional<bool> allow_repeats = {};
};

/// Takes a frame and makes it touchable, asking its second argument for the time from which on.
/// Called on a thread of the stream.
using FrameSink = std::function<void(const DepthFrame&, const StartTime&)>;

/// From a camera to a source: one thread reads, another prepares. A frame that comes while the one
/// before is being prepared waits, and the next takes its place: frames are dropped, never queued,
/// so that what is felt is never older than it must be. A camera that does not pace itself
/// (CameraInfo::paces) is read when preparation is ready, and loses nothing.
///
/// No frame of a camera, and nothing that it or preparation throws, ends a stream: it is counted
/// and told by state(). What stops coming fades as the source's PolicyOptions say; but what the
/// last frames of a recording showed stays (Source::keep).
class Stream {
 public:
  /// Lets the camera begin and starts the threads. Camera, source and clock outlive the stream, and
  /// nobody else reads or pushes.
  /// @throws Error when an option is out of range or the camera cannot begin.
  Stream(DepthCamera& camera, Source& source, const Clock& clock,
         const StreamOptions& options = {});

  /// The same into any sink; `name` stands for it in messages. `ended`, if any, is called after the
  /// last frame of a recording, on the thread that calls the sink.
  Stream(DepthCamera& camera, const std::string& name, FrameSink sink, const Clock& clock,
         const StreamOptions& options = {}, std::function<void()> ended = {});

  /// Stops: waits for a read() and a preparation that are under way, and for nothing else.
  ~Stream();
  Stream(Stream&&) noexcept;
  Stream& operator=(Stream&&) noexcept;

  /// How it fares. Any thread; takes a lock, so not for a servo's.
  [[nodiscard]] StreamState state() const;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace palpate
