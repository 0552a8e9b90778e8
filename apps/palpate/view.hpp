#pragma once

#include <memory>

#include "apps/palpate/live_feed.hpp"
#include "apps/palpate/run.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// The page on which a run in real time is seen and set, and on which its tool is taken.
class View {
 public:
  /// Serves from now on, and says on standard error where. All that it is given outlives it.
  /// @throws Error when the address or the port cannot be had.
  View(Run& run, Servo& servo, const LiveFeed& feed);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Every step, in order; one thread, that of look().
  void add(const TouchStep& step);

  /// Some tens of times a second: says of a page that has the tool that it still has.
  void look();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::app
