#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// What a stream is doing.
enum class StreamPhase {
  starting,  ///< no frame has come yet
  running,   ///< frames come
  stalled,   ///< no frame of use came for some time: silence, one picture again and again, garbage
  failed,    ///< the camera says that it cannot; it is asked again, ever more rarely
  ended,     ///< the recording is over and its last frame is prepared
};

/// "starting", "running", ... : its name in data.
[[nodiscard]] std::string_view name_of(StreamPhase phase) noexcept;

/// Frames that came and were not made touchable, by cause.
struct StreamDrops {
  std::uint64_t overtaken = 0;  ///< a newer one came before preparation was ready for it
  std::uint64_t repeated = 0;   ///< bit for bit the one before
  std::uint64_t late = 0;       ///< taken no later than the one before, or at no sensible time
  std::uint64_t empty = 0;      ///< not one pixel with a depth: a covered lens
  std::uint64_t garbage = 0;    ///< damaged, or contradicts itself
  std::uint64_t unposed = 0;    ///< without a pose, in a recording that has poses
  std::uint64_t resized = 0;    ///< of another size than those before, until that size lasts
  std::uint64_t refused = 0;    ///< preparation threw

  [[nodiscard]] std::uint64_t total() const {
    return overtaken + repeated + late + empty + garbage + unposed + resized + refused;
  }
};

/// How a stream fares, for whoever looks on.
struct StreamState {
  std::string source;  ///< name of the source that is fed
  std::string camera;  ///< CameraInfo::name
  StreamPhase phase = StreamPhase::starting;
  double rate = 0;           ///< of the last 8 frames, Hz; falls in silence, but not after the end
  std::uint64_t frames = 0;  ///< that the camera delivered, whatever became of them
  std::uint64_t touchable = 0;  ///< of them prepared and published
  StreamDrops drops;
  std::uint64_t stalls = 0;        ///< times that it stalled
  std::uint64_t failures = 0;      ///< reads that failed
  std::uint64_t retries = 0;       ///< of them followed by another read
  std::uint64_t size_changes = 0;  ///< new sizes of frames that lasted
  double last_frame = 0;           ///< when the last frame came, s on the stream's clock
  double latency_mean = 0;         ///< from stamp to touchable, s
  double latency_worst = 0;        ///< s
  std::string problem;             ///< the last one, in words, naming the source; empty: none yet
  double problem_at = 0;           ///< s on the stream's clock
};

}  // namespace palpate
