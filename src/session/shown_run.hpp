#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "session/recording.hpp"

namespace palpate::session {

/// A recorded hand as a servo shows it that nobody steps. One thread; the servo's watchers may be
/// on others.
class ShownHand {
 public:
  /// `recording` and `scene` outlive it.
  ShownHand(const Recording& recording, std::size_t index, Scene& scene);

  [[nodiscard]] Servo& servo() { return servo_; }

  /// Shows the last step at or before `time`, s on the run's clock.
  void seek(double time);
  /// Shows all steps up to `time` that were not shown yet.
  void advance(double time);

  /// The forces in the `span` (s) before the step that is shown; none where `cancelled`.
  /// Damaged ones are left out.
  [[nodiscard]] std::vector<ViewerControls::TimeLine::Force> past(
      double span, const std::function<bool()>& cancelled);

 private:
  void show(const Recording::Step& step);

  const Recording::Hand* hand_;
  Recording::Steps steps_;
  Recording::Steps earlier_;
  RecordedDevice device_;
  Servo servo_;
  Guard::State::Counts counts_;  // of what was shown
};

/// Shows a source of a recorded run. One thread shows; others may read the stream.
class ShownSource {
 public:
  using Stream = ViewerOptions::Stream;

  /// One that stands still shows its surface, one that lives its first one. `scene` outlives it.
  ShownSource(const Recording& recording, std::size_t index, Scene& scene);

  /// Shows the newest frame that was felt at `time` (s, on the run's clock), prepared by itself.
  /// @throws Error when a frame was damaged: the newest that was read before it is shown.
  void show(double time);

  [[nodiscard]] bool lives() const { return origin_->lives; }
  /// When its first surface was felt, s on the run's clock; infinite where none was.
  [[nodiscard]] double begins() const { return begins_; }
  /// State and frustum of a camera.
  [[nodiscard]] Stream stream() const;

 private:
  [[nodiscard]] std::optional<RecordedFrame> next_felt();
  void read_on(double time, std::optional<RecordedFrame>& newest);
  void prepare(const RecordedFrame& recorded);

  Source* source_;
  const Recording::Origin* origin_;
  Recording::Frames frames_;
  double begins_ = -std::numeric_limits<double>::infinity();
  double shown_until_ = 0;                 // frames up to that time were looked at, s
  std::optional<RecordedFrame> upcoming_;  // the first after that
  mutable std::mutex mutex_;
  Stream stream_;
};

/// Hands and sources of a recorded run, in a scene of their own.
struct ShownRun {
  /// @throws Error when the file is no recording of a run.
  explicit ShownRun(bag::RandomFile file);

  [[nodiscard]] double length() const { return stretch.end - stretch.begin; }
  /// When there was a surface first, s from the first step on; 0 where there was none.
  [[nodiscard]] double first_surface() const;

  Recording recording;
  Recording::Stretch stretch;
  Scene scene;
  std::deque<ShownSource> sources;
  std::deque<ShownHand> hands;
};

}  // namespace palpate::session
