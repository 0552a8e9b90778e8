#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/palpate/run/run.hpp"
#include "apps/palpate/run/view_settings.hpp"

namespace palpate::app {

/// Prepares the sources of a run anew, on a thread of its own, as somebody who watches wants them.
/// Of wishes that come faster than it works the last one counts. What fails is taken back.
class Preparer {
 public:
  /// Called on the preparer's thread: why a preparation failed, and what sources are prepared by.
  using Failed = std::function<void(const std::string& why, const ViewSettings& held)>;

  /// `initial`: what the run began with. The run outlives it.
  Preparer(Run& run, const ViewSettings& initial, Failed failed);
  ~Preparer();
  Preparer(const Preparer&) = delete;
  Preparer& operator=(const Preparer&) = delete;

  /// Waits for what is under way and begins nothing any more.
  void stop();

  /// Any thread; returns at once.
  void want(const ViewSettings& settings);

 private:
  void work(const std::stop_token& stop);
  void prepare(const ViewSettings& settings);
  void take_back();

  Run& run_;
  ViewSettings initial_;
  ViewSettings held_;  // the last that sources could be prepared by
  Failed failed_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<ViewSettings> wanted_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate::app
