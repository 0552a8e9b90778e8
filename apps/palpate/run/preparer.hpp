// Prepares sources again while they are touched.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "apps/palpate/run/run.hpp"
#include "session/view_settings.hpp"

namespace palpate::app {

/// Prepares the sources of a run again, on a thread of its own, with the settings of the page.
/// If requests come faster than it works, the last one counts. A failed request is undone.
class Preparer {
 public:
  using Preparation = session::ViewSettings::Preparation;
  /// Called on the preparer's thread: why a preparation failed, and what sources are prepared by.
  using Failed = std::function<void(const std::string& why, const Preparation& held)>;

  /// `initial`: what the run began with. The run outlives it.
  Preparer(Run& run, const Preparation& initial, Failed failed);
  ~Preparer();
  Preparer(const Preparer&) = delete;
  Preparer& operator=(const Preparer&) = delete;

  /// Waits for the current preparation and begins nothing any more.
  void stop();

  /// Any thread; returns at once.
  void want(const Preparation& wanted);

 private:
  void work(const std::stop_token& stop);
  void prepare(const Preparation& wanted);
  void change_all(const Preparation& wanted);
  void finish_cut_off();

  Run& run_;
  Preparation initial_;
  Preparation held_;               // the last that sources could be prepared by
  std::set<std::size_t> cut_off_;  // sources whose preparation other options stopped
  Failed failed_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Preparation> wanted_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate::app
