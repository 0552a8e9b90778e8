#pragma once

#include <memory>
#include <vector>

#include "apps/palpate/run/run.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// The page on which a run in real time is seen and set, and on which its tools are taken.
class View {
 public:
  /// Serves from now on, and says on standard error where. All that it is given outlives it;
  /// `servos` are those of the run's hands, in their order.
  /// @throws Error when the address or the port cannot be had.
  View(Run& run, std::vector<Servo*> servos, const LiveFeed& feed);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Some tens of times a second: says of pages that have a tool that they still have.
  void look();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::app
