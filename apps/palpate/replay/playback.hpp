#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "session/played_run.hpp"

namespace palpate::app {

/// A recorded run that plays in real time. Threads of its own read the file: one the steps, one the
/// frames, one all forces once.
class Playback {
 public:
  using TimeLine = session::PlayedRun::TimeLine;

  /// Callbacks on the playback's threads.
  struct Listener {
    std::function<void()> changed;   ///< there is another past, and maybe another envelope
    std::function<void()> envelope;  ///< there is another envelope
    std::function<void(const std::string&)> complain;  ///< what is damaged
  };

  /// Shows the first moment that has a surface. @throws Error when the file is no recording of a
  /// run.
  explicit Playback(const std::string& path);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  [[nodiscard]] Scene& scene() { return run_.scene(); }
  [[nodiscard]] std::vector<Servo*> servos() { return run_.servos(); }

  /// Starts the threads. From now on any thread may call the rest; stop() ends the notifications.
  void start(Listener listener);
  void stop();

  /// PlayedRun's, of this playback, which outlives it.
  [[nodiscard]] TimeLine time_line() { return run_.time_line(); }
  [[nodiscard]] ViewerOptions viewer_options() { return run_.viewer_options(); }

 private:
  void wake();
  void guard(const std::function<void()>& work);
  void show_steps(const std::stop_token& stop);
  void show_frames(const std::stop_token& stop);
  void read_forces(const std::stop_token& stop);

  session::PlayedRun run_;
  Listener listener_;
  std::mutex mutex_;  // nobody is woken between looking and waiting
  std::condition_variable_any changed_;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace palpate::app
