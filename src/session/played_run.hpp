#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "session/recording.hpp"
#include "session/shown_run.hpp"

namespace palpate::session {

/// A recorded run that goes by as it did, or is shown at any moment, by whoever says how much time
/// has passed. Holds no more of the file than what is shown. show(), show_frames() and
/// read_forces() may each have a thread of its own; the rest is for any thread.
class PlayedRun {
 public:
  using TimeLine = ViewerControls::TimeLine;
  /// Gets what is damaged, or cannot be shown.
  using Complain = std::function<void(const std::exception&)>;

  static constexpr double kPast = 5;               ///< s that a hand's past goes back
  static constexpr std::size_t kEnvelope = 1'000;  ///< parts of the envelope
  static constexpr double kNews = 0.5;  ///< s between two envelopes while it is read; judgement

  /// Shows the first moment that has a surface, its past with the first show(). `called`: there is
  /// something else to show. @throws Error when the file is no recording of a run.
  explicit PlayedRun(
      bag::RandomFile file, std::function<void()> called = [] {});
  PlayedRun(const PlayedRun&) = delete;
  PlayedRun& operator=(const PlayedRun&) = delete;

  [[nodiscard]] Scene& scene() { return run_.scene; }
  [[nodiscard]] std::vector<Servo*> servos();

  /// Shows and moves this run, which outlives it. Times from 0 at the run's first step: a seek
  /// beyond the length goes to the end; who plays at the end begins again.
  [[nodiscard]] TimeLine time_line();
  /// What pages of this run, which outlives them, have in common: its name, its cameras and, where
  /// it was in the axes of a camera's picture, y down, the view of that camera.
  [[nodiscard]] ViewerOptions viewer_options();
  [[nodiscard]] bool has_cameras() const;
  [[nodiscard]] TimeLine::Moment moment() const;
  /// Waits a moment that was sought to be shown?
  [[nodiscard]] bool is_sought() const;

  /// Shows what was sought and reads the forces before it, unless that is `cancelled`; else what is
  /// `elapsed` s later, where it plays. True: something was sought. A damaged step pauses it, and
  /// it plays on behind that.
  bool show(double elapsed, const std::function<bool()>& cancelled, const Complain& complain);
  /// Shows the cameras' frames of the present moment, which it returns.
  double show_frames(const Complain& complain);
  /// Reads the forces of the next `steps` for the envelope. False: there are no more.
  bool read_forces(std::size_t steps);
  /// What read_forces() found damaged so far, in words. For its thread.
  [[nodiscard]] const std::vector<std::string>& losses() const { return steps_.losses(); }

 private:
  struct FieldChange {
    double time = 0;  // s, on the run's clock
    FieldOptions field;
  };

  [[nodiscard]] std::vector<ViewerOptions::Stream> streams() const;
  void seek(double time);
  void play(bool on, double speed);
  void jump(double time, const std::function<bool()>& cancelled);
  void advance(double elapsed);
  void show_fields(double time);
  void take(const Recording::Step& step);
  [[nodiscard]] bool take_field(std::size_t hand, const FieldChange& change);

  ShownRun run_;
  Recording::Steps steps_;  // that read_forces() reads
  std::function<void()> called_;

  mutable std::mutex mutex_;  // of what follows
  TimeLine::Moment moment_;
  std::optional<double> sought_;  // not shown yet
  std::vector<float> envelope_;
  std::vector<std::vector<TimeLine::Force>> pasts_;  // of each hand
  std::vector<std::vector<FieldChange>> fields_;     // of each hand, as far as they are known
};

}  // namespace palpate::session
