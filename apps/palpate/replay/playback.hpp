#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/palpate/record/recording.hpp"
#include "apps/palpate/replay/shown_run.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

/// A recorded run that goes by as it did, or is shown at any moment. Threads of its own read the
/// file: one the steps, one the frames, one all forces once. Holds no more of the file than what is
/// shown.
class Playback {
 public:
  using TimeLine = ViewerControls::TimeLine;

  /// Callbacks on the playback's threads.
  struct Listener {
    std::function<void()> changed;  ///< there is another envelope, or another past
    std::function<void(const std::string&)> complain;  ///< what is damaged
  };

  static constexpr double kPast = 5;               ///< s that a hand's past goes back
  static constexpr std::size_t kEnvelope = 1'000;  ///< parts of the envelope

  /// Shows the first moment that has a surface. @throws Error when the file is no recording of a
  /// run.
  explicit Playback(const std::string& path);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  [[nodiscard]] Scene& scene() { return run_.scene; }
  [[nodiscard]] std::vector<Servo*> servos();
  /// Was the run in the axes of a camera's picture, y down?
  [[nodiscard]] bool in_picture_axes() const { return run_.recording.in_picture_axes(); }

  /// Starts the threads. From now on any thread may call the rest; stop() ends the notifications.
  void start(Listener listener);
  void stop();

  /// Shows and moves this playback, which outlives it. Times from 0 at the run's first step: a seek
  /// beyond the length goes to the end; who plays at the end begins again.
  [[nodiscard]] TimeLine time_line();
  [[nodiscard]] std::vector<ViewerOptions::Stream> streams() const;

 private:
  struct FieldChange {
    double time = 0;  // s, on the run's clock
    FieldOptions field;
  };

  void seek(double time);
  void play(bool on, double speed);
  void guard(const std::function<void()>& work);
  void show_steps(const std::stop_token& stop);
  void jump(double time, const std::stop_token& stop);
  void advance(double elapsed);
  void show_fields(double time);
  void show_frames(const std::stop_token& stop);
  void read_forces(const std::stop_token& stop);
  void take(const Recording::Step& step);

  ShownRun run_;
  Listener listener_;

  std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  TimeLine::Moment moment_;
  std::optional<double> sought_;  // not shown yet
  std::vector<float> envelope_;
  std::vector<std::vector<TimeLine::Force>> pasts_;  // of each hand
  std::vector<std::vector<FieldChange>> fields_;     // of each hand, as far as they are read
  std::vector<std::jthread> threads_;                // last: they use all of the above
};

}  // namespace palpate::app
