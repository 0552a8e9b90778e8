#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/palpate/record/record_queues.hpp"
#include "apps/palpate/record/recording_file.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "message/palpate_types.hpp"
#include "palpate/ros/bridge.hpp"
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

/// Writes a run to MCAP files, one at a time: a first one from the run's beginning, with all that
/// `palpate replay` does it again from (docs/bags.md), others from any moment on. A servo puts its
/// steps into a queue, a stream's thread its frames into another; a thread of the recorder's own
/// writes them. Where it falls behind, steps and frames are left out and counted; nothing waits for
/// it but simulated time. While nothing is recorded, queues take nothing and the thread sleeps.
class Recorder {
 public:
  /// Makes the file of the run from its beginning; none where `path` is empty.
  /// @throws Error when it cannot.
  explicit Recorder(const std::string& path = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Adds a hand. Returns the queue that its servo puts its steps into.
  [[nodiscard]] StepTraces* add_hand();

  /// Writes what the run is made of into the first file and starts the thread. All hands are there,
  /// no stream is yet; scene and servos outlive the calls of record(). `now`: s, on the run's
  /// clock. `waits`: frames wait for the file. @throws Error when the file cannot be written.
  void begin(LoadedScene& loaded, std::vector<const Servo*> servos, double now, bool waits);

  /// Begins a file in the working folder that is named after the time of day, or ends the current
  /// one; no effect if it is recording already. Returns its name; empty: there was none to end. Any
  /// thread, after begin(). Returns at once; the recorder's thread does the rest.
  /// @throws Error when the file cannot be made, and nothing changes.
  std::string record(bool on);
  /// The file that is being recorded; empty: none. Any thread.
  [[nodiscard]] std::string recording() const { return orders_.name(); }

  /// Called on the recorder's thread with why a file ended by itself, the run going on. When
  /// on_broken() has returned, the one before is called no more.
  using Broken = std::function<void(const std::string& why)>;
  void on_broken(Broken broken);

  /// `sink`, whose frames are recorded with what became of them.
  [[nodiscard]] Stream::Sink watching(std::size_t source, Stream::Sink sink);
  /// `ended`, whose call is recorded.
  [[nodiscard]] std::function<void()> watching(std::size_t source, std::function<void()> ended);

  /// What targets a robot got by `now`, s on the run's clock, if there is one: recorded where it
  /// differs from the time before. The thread of the run.
  void note(double now, const std::optional<RosBridge::RobotState>& robot);

  /// Waits until there is room for steps: for simulated time.
  void keep_up();

  /// Writes the rest and closes the file. Servos and streams have stopped. How each file went.
  [[nodiscard]] std::vector<RecordReport> finish();

 private:
  // The file that is written, how it goes, and how many steps were lost before it.
  struct Present {
    std::unique_ptr<RecordingFile> file;  // null: nothing is recorded
    RecordReport report;
    std::uint64_t dropped = 0;
  };

  // What is recorded, once that has begun.
  struct Subject {
    LoadedScene* loaded = nullptr;
    std::vector<const Servo*> servos;
    std::int64_t epoch = 0;  // ns

    [[nodiscard]] RecordedSetup setup() const { return setup_of(*loaded, servos, epoch); }
    [[nodiscard]] Source& source(std::size_t i) const { return loaded->scene.source(i); }
  };

  void put(std::size_t source, message::FrameUse use, DepthFrame frame);
  void work();
  void carry_out(RecordOrder order);
  void close();
  void fail(const std::string& why);
  void accept(bool on);
  void drain();
  [[nodiscard]] std::uint64_t dropped() const;

  // The thread's, once it has begun.
  Present present_;
  std::vector<RecordReport> reports_;

  std::deque<StepTraces> hands_;
  Subject subject_;
  std::string robot_;  // what was noted of it last; the run's thread's
  std::atomic<bool> takes_frames_{false};
  WaitingFrames waiting_;
  RecordOrders orders_;
  std::mutex broken_mutex_;
  Broken broken_;
  std::thread thread_;
};

}  // namespace palpate::app
