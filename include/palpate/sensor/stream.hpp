#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "palpate/base/clock.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate {

/// State of a stream, for display and logs.
struct StreamState {
  /// Frames that came and were not made touchable, by cause.
  struct Drops {
    std::uint64_t overtaken = 0;  ///< a newer one came before preparation was ready for it
    std::uint64_t repeated = 0;   ///< bit for bit the one before
    std::uint64_t late = 0;       ///< taken no later than the one before, or at no sensible time
    std::uint64_t empty = 0;      ///< not one pixel with a depth, or no point: a covered lens
    std::uint64_t garbage = 0;    ///< damaged, or contradicts itself
    std::uint64_t unposed = 0;    ///< without a pose, in a recording that has poses
    std::uint64_t resized = 0;    ///< of another size than those before, until that size lasts
    std::uint64_t refused = 0;    ///< preparation threw

    [[nodiscard]] std::uint64_t total() const {
      return overtaken + repeated + late + empty + garbage + unposed + resized + refused;
    }
  };

  /// State of a stream.
  enum class Phase {
    starting,  ///< no frame has come yet
    running,   ///< frames come
    stalled,  ///< no frame of use came for some time: silence, one picture again and again, garbage
    failed,   ///< the camera reports that it cannot; it is read again, ever more rarely
    ended,    ///< the recording is over and its last frame is prepared
  };

  std::string source;  ///< name of the source that is fed
  std::string camera;  ///< CameraInfo::name
  Phase phase = Phase::starting;
  double rate = 0;              ///< of the last second or 8 frames, whichever is more, Hz; falls in
                                ///< silence, but not after the end
  std::uint64_t frames = 0;     ///< that the camera delivered, whatever became of them
  std::uint64_t touchable = 0;  ///< of them prepared and published
  Drops drops;
  std::uint64_t stalls = 0;        ///< times that it stalled
  std::uint64_t failures = 0;      ///< reads that failed
  std::uint64_t retries = 0;       ///< of them followed by another read
  std::uint64_t size_changes = 0;  ///< new sizes of frames that lasted
  double last_frame = 0;           ///< when the last frame came, s on the stream's clock
  double latency_mean = 0;         ///< from stamp to touchable, s
  double latency_worst = 0;        ///< s
  double age = 0;                  ///< of the newest frame that is touchable, s; 0: none is yet
  std::string problem;             ///< the last one, in words, naming the source; empty: none yet
  double problem_at = 0;           ///< s on the stream's clock
};

/// "starting", "running", ... : its name in data.
[[nodiscard]] std::string_view name_of(StreamState::Phase phase) noexcept;

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
  /// frozen camera's surface fades as a silent one's does. Unset: as CameraInfo::repeats.
  std::optional<bool> allow_repeats = {};
};

/// Brings a camera's frames to a source: one thread reads, another prepares. A frame that comes
/// while the one before is being prepared waits, and the next replaces it: frames are dropped,
/// never queued, so that the rendered surface is no older than it must be. A camera that does not
/// pace itself (CameraInfo::paces) is read when preparation is ready, and loses nothing.
///
/// No frame of a camera, and nothing that it or preparation throws, ends a stream: it is counted
/// and reported by state(). What stops coming fades by the source's PolicyOptions; but what the
/// last frames of a recording showed stays (Source::keep).
class Stream {
 public:
  /// Takes a frame and makes it touchable; its second argument returns the time from which on. An
  /// image that measures nothing comes, too, and makes no surface: the time is not asked for.
  /// Called on a thread of the stream.
  using Sink = std::function<void(const DepthFrame&, const Source::StartTime&)>;

  /// Lets the camera begin and starts the threads. Camera, source and clock outlive the stream, and
  /// nobody else reads or pushes.
  /// @throws Error when an option is out of range or the camera cannot begin.
  Stream(DepthCamera& camera, Source& source, const Clock& clock,
         const StreamOptions& options = {});

  /// The same into any sink; `name` stands for it in messages. `ended`, if any, is called after the
  /// last frame of a recording, on the thread that calls the sink.
  Stream(DepthCamera& camera, const std::string& name, Sink sink, const Clock& clock,
         const StreamOptions& options = {}, std::function<void()> ended = {});

  /// Stops: waits for a read() and a preparation that are in progress, and for nothing else.
  ~Stream();
  Stream(Stream&&) noexcept;
  Stream& operator=(Stream&&) noexcept;

  /// Its state. Any thread; takes a lock, so not for a servo's.
  [[nodiscard]] StreamState state() const;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

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
/// A camera that has no frame, or none that comes after the one before, is read again one frame's
/// time later: it is not given up, and does not hold up time either.
class SimulatedStream {
 public:
  /// Lets the camera begin. Camera and source outlive the stream, and nobody else reads or pushes.
  /// @throws Error when an option is out of range, when the camera keeps its own time
  /// (CameraInfo::paces) or gives no rate, or cannot begin.
  SimulatedStream(DepthCamera& camera, Source& source, const SimulatedStreamOptions& options = {});

  /// The same into any sink; `name` stands for it in messages. `ended`, if any, is called after the
  /// last frame of a recording.
  SimulatedStream(DepthCamera& camera, const std::string& name, Stream::Sink sink,
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
