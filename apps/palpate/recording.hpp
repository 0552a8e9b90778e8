#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "apps/palpate/log.hpp"

namespace palpate::app {

/// The log of steps that a page begins and ends while a run goes on: a file a hand.
class Recording {
 public:
  explicit Recording(std::size_t hands) : hands_(hands) {}

  /// Begins files named after the time of day, or ends those that were begun. Returns the first
  /// one's name. @throws Error when they cannot be made or written.
  std::string record(bool on);

  /// Another thread's: a step of a hand.
  void add(std::size_t hand, const TouchStep& step);

 private:
  std::size_t hands_;
  std::mutex mutex_;
  std::string name_;
  std::vector<TouchLog> logs_;  // empty: nothing is recorded
};

}  // namespace palpate::app
