#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/palpate/record/recording_file.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "message/palpate_types.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"
#include "servo/step_trace.hpp"

namespace palpate::app {

/// How a recording went.
struct RecordReport {
  std::string path;
  std::uint64_t steps = 0;
  std::uint64_t lost_steps = 0;  ///< there was no room for them
  std::uint64_t frames = 0;
  std::uint64_t lost_frames = 0;
  std::string problem;  ///< why it ended early; empty: it did not
};

/// Writes a run to an MCAP file, with all that `palpate replay` does it again from (docs/bags.md).
/// A servo puts its steps into a queue, a stream's thread its frames into another; a thread of the
/// recorder's own writes them. Where it falls behind, steps and frames are left out and counted;
/// nothing waits for it but simulated time.
class Recorder {
 public:
  /// Makes the file. @throws Error when it cannot.
  explicit Recorder(const std::string& path);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// One more hand: what its servo puts its steps into.
  [[nodiscard]] StepTraces* add_hand();

  /// Writes what the run is made of and starts the thread. All hands are there, no stream is yet;
  /// scene and servos outlive finish(). `now`: s, on the run's clock. `waits`: frames wait for the
  /// file. @throws Error when the file cannot be written.
  void begin(LoadedScene& loaded, const std::vector<const Servo*>& servos, double now, bool waits);

  /// `sink`, whose frames are recorded with what became of them.
  [[nodiscard]] Stream::Sink watching(std::size_t source, Stream::Sink sink);
  /// `ended`, whose call is recorded.
  [[nodiscard]] std::function<void()> watching(std::size_t source, std::function<void()> ended);

  /// Waits until there is room for steps: for simulated time.
  void keep_up();

  /// Writes the rest and closes the file. Servos and streams have stopped.
  [[nodiscard]] RecordReport finish();

 private:
  void put(std::size_t source, message::FrameUse use, DepthFrame frame);
  void work();
  void drain(bool writes);

  std::unique_ptr<RecordingFile> file_;  // the thread's, once it has begun
  std::deque<StepTraces> hands_;
  LoadedScene* loaded_ = nullptr;
  bool waits_ = false;
  std::mutex mutex_;  // of what follows, but that changes_[i] is source i's stream's
  std::condition_variable room_;
  std::condition_variable ended_;
  std::deque<RecordedFrame> frames_;
  std::vector<std::uint64_t> changes_;  // of each source's options, that were told
  bool ending_ = false;
  RecordReport report_;  // the thread's but for lost_frames
  std::thread thread_;
};

}  // namespace palpate::app
