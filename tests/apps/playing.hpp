#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/palpate/replay/playback.hpp"

namespace palpate::app {

/// A player of a recording whose threads run, and what it told.
class Playing {
 public:
  static constexpr double kBegin = 7;  // s, on the run's clock

  explicit Playing(const std::string& path) : player(path) {
    player.start({[this] { ++changes; }, [this] { ++envelopes; },
                  [this](const std::string& why) {
                    const std::lock_guard lock(mutex_);
                    complaints_.push_back(why);
                  }});
  }
  ~Playing() { player.stop(); }
  Playing(const Playing&) = delete;
  Playing& operator=(const Playing&) = delete;

  // Hangs until the test's time is over if that never comes.
  static void wait(const std::function<bool()>& so) {
    while (!so()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  [[nodiscard]] double shown(std::size_t hand) {
    return player.servos()[hand]->state().time - kBegin;
  }

  [[nodiscard]] std::vector<std::string> complained() {
    const std::lock_guard lock(mutex_);
    return complaints_;
  }

  Playback player;
  Playback::TimeLine line = player.time_line();
  std::atomic<int> changes{0};
  std::atomic<int> envelopes{0};

 private:
  std::mutex mutex_;
  std::vector<std::string> complaints_;
};

}  // namespace palpate::app
