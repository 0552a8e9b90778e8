#pragma once

#include <optional>

#include "apps/palpate/report/live_report.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/touch/live_status.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

/// One hand of a run in real time: its servo, on a thread of its own from construction on. The
/// thread that made it calls all the rest.
class LiveHand {
 public:
  /// Run and clock outlive it. @throws Error when there is no thread to be had.
  LiveHand(Run& run, std::size_t index, WaitingClock& clock);
  LiveHand(const LiveHand&) = delete;
  LiveHand& operator=(const LiveHand&) = delete;

  /// The run's time 0, s on the clock. What came before is left out.
  void begin(double start);

  /// Hands its new steps to `each`, with the force that was felt and times from 0.
  void take_steps(const EachStep& each);

  /// Has it come to its end, whatever ended it?
  [[nodiscard]] bool over(double now) const;

  /// Why its device failed; empty: it did not.
  [[nodiscard]] std::string failure() const;

  /// How it goes since the moment before.
  [[nodiscard]] HandMoment moment(double now);

  /// Ends the thread: zero force. Its last steps can be taken then.
  void stop() { thread_.stop(); }
  [[nodiscard]] LiveReport report() const;

  [[nodiscard]] Servo& servo() { return servo_; }

 private:
  Hand& hand_;
  std::size_t index_;
  double rate_;
  std::optional<PacedDevice> paced_;  // of a device that defines its own time
  StepQueue steps_;
  Servo servo_;
  double start_ = 0;
  double looked_ = 0;
  double force_ = 0;  // the longest since then, N
  Durations lateness_;
  Durations computing_;
  ServoThread thread_;  // last: it uses all of the above
};

}  // namespace palpate::app
