// Declares what waits for a recorder's thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "apps/palpate/record/recording_file.hpp"
#include "message/palpate_types.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "stream/source_trace.hpp"

namespace palpate::app {

inline constexpr std::chrono::milliseconds kQueueLook{5};  ///< between two looks (judgement)

/// Frames, and states of a robot, that wait to be written. Any thread.
class WaitingFrames {
 public:
  struct Taken {
    std::deque<session::RecordedFrame> frames;
    std::deque<RecordedRobot> robots;
  };

  /// So many sources. `waits`: put() waits until there is room.
  void begin(std::size_t sources, bool waits);

  /// Adds a frame, or leaves it out and counts it where there is no room. `trace`: of its source,
  /// whose stream's thread calls this.
  void put(std::size_t source, message::FrameUse use, DepthFrame frame, const SourceTrace& trace);
  void put(RecordedRobot robot);

  [[nodiscard]] Taken take();

  /// A file begins: what was left out before is no gap in it.
  void forget_gaps();

  /// How many frames were left out since the last call.
  [[nodiscard]] std::uint64_t take_lost();

 private:
  std::mutex mutex_;
  std::condition_variable room_;
  Taken waiting_;
  bool waits_ = false;
  std::uint64_t lost_ = 0;
  std::vector<std::uint64_t> changes_;  // of each source's options, that were reported
  std::vector<char> gaps_;              // of each source: its last frame was not recorded
};

/// A file to begin, or, where that is null, the end of the present one.
struct RecordOrder {
  std::unique_ptr<RecordingFile> file;
  std::string path;
  RecordedSetup setup;
};

/// What people request of a recorder. Any thread.
class RecordOrders {
 public:
  /// `name`: of the file that is recorded from the beginning; empty: none.
  explicit RecordOrders(std::string name) : name_(std::move(name)) {}

  /// Requests the file that `make` makes, or the end of the present one; nothing if that is how
  /// it is already. Returns its name. What `make` throws changes nothing.
  std::string record(bool on, const std::function<RecordOrder()>& make);

  /// The file that was requested last; empty: it was ended.
  [[nodiscard]] std::string name() const;

  /// Notes that this file ended by itself.
  void forget(const std::string& name);

  /// No order comes any more.
  void end();

  /// Waits for orders and returns them; `looks`: for a few milliseconds at most. Sets `last` when
  /// there are no more.
  [[nodiscard]] std::deque<RecordOrder> wait(bool looks, bool& last);

 private:
  mutable std::mutex mutex_;
  std::condition_variable called_;
  std::string name_;
  std::deque<RecordOrder> orders_;
  bool ending_ = false;
};

}  // namespace palpate::app
