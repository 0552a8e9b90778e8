#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

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
  [[nodiscard]] std::string recording() const;

  /// Is told on the recorder's thread why a file ended by itself, the run going on. When
  /// on_broken() has returned, the one before is called no more.
  using Broken = std::function<void(const std::string& why)>;
  void on_broken(Broken broken);

  /// `sink`, whose frames are recorded with what became of them.
  [[nodiscard]] Stream::Sink watching(std::size_t source, Stream::Sink sink);
  /// `ended`, whose call is recorded.
  [[nodiscard]] std::function<void()> watching(std::size_t source, std::function<void()> ended);

  /// What a robot was told by `now`, s on the run's clock, if there is one: recorded where it says
  /// something else than the time before. The thread of the run.
  void note(double now, const std::optional<RosBridge::RobotState>& robot);

  /// Waits until there is room for steps: for simulated time.
  void keep_up();

  /// Writes the rest and closes the file. Servos and streams have stopped. How each file went.
  [[nodiscard]] std::vector<RecordReport> finish();

 private:
  // To begin a file, or, where that is null, to end the present one.
  struct Order {
    std::unique_ptr<RecordingFile> file;
    std::string path;
    RecordedSetup setup;
  };

  void put(std::size_t source, message::FrameUse use, DepthFrame frame);
  void work();
  void carry_out(Order order);
  void close();
  void fail(const std::string& why);
  void accept(bool on);
  void drain();
  [[nodiscard]] std::uint64_t dropped() const;

  // The thread's, once it has begun.
  std::unique_ptr<RecordingFile> file_;  // null: nothing is recorded
  RecordReport report_;                  // of it
  std::uint64_t dropped_ = 0;            // steps before it
  std::vector<RecordReport> reports_;

  std::deque<StepTraces> hands_;
  LoadedScene* loaded_ = nullptr;
  std::vector<const Servo*> servos_;
  std::string robot_;       // what was noted of it last; the run's thread's
  std::int64_t epoch_ = 0;  // ns
  bool waits_ = false;
  std::atomic<bool> takes_frames_{false};
  mutable std::mutex mutex_;  // of what follows, but that changes_[i] is source i's stream's
  std::condition_variable room_;
  std::condition_variable called_;
  std::string name_;  // of the file that was asked for last; empty: it was ended
  std::deque<Order> orders_;
  std::deque<RecordedFrame> frames_;
  std::deque<RecordedRobot> robots_;    // states of the robot
  std::uint64_t lost_frames_ = 0;       // of the present file
  std::vector<std::uint64_t> changes_;  // of each source's options, that were told
  std::vector<char> gaps_;              // of each source: its last frame was not recorded
  bool ending_ = false;
  std::mutex broken_mutex_;
  Broken broken_;
  std::thread thread_;
};

}  // namespace palpate::app
