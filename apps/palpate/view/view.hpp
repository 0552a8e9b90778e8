#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "apps/palpate/options/touch_plan.hpp"
#include "apps/palpate/run/run.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

/// The page on which a run in real time is seen and set, and on which its tools are taken.
class View {
 public:
  /// Serves from now on, and prints on standard error where. All that it is given outlives it;
  /// `servos` are those of the run's hands, in their order; `bridge` may be null.
  /// @throws Error when the address or the port cannot be had.
  View(Run& run, std::vector<Servo*> servos, const LiveFeed& feed, const RosBridge* bridge);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Some tens of times a second: renews the tools that pages still have. Where a page
  /// opened a file, and what comes next has been prepared: the page of that.
  [[nodiscard]] std::optional<PagePlan> look();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The page of a run whose clouds are being read: it is there once that has taken a while, and
/// shows how far it is. The run's own page follows at the same address.
class WaitingPage {
 public:
  /// `patience`: reading that takes less opens no page.
  explicit WaitingPage(const TouchPlan& plan,
                       std::chrono::milliseconds patience = std::chrono::milliseconds(500));
  ~WaitingPage();
  WaitingPage(const WaitingPage&) = delete;
  WaitingPage& operator=(const WaitingPage&) = delete;

  /// `plan` with sources that report to this page how far they are read. It outlives their reading.
  [[nodiscard]] TouchPlan watching(TouchPlan plan);

  /// Closes it. The page that is to follow.
  [[nodiscard]] PagePlan end();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::app
