#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "scene.hpp"
#include "ticks.hpp"

namespace palpate::python {

/// Options to make a servo with, beside its scene.
struct ServoPlan {
  std::string device = "simulated";  ///< or remote[:PATH], or a name that open_device() knows
  Trajectory hand = {};              ///< of a simulated device, world frame
  ServoOptions servo = {};
  RealtimeOptions realtime = {};
  std::optional<double> rate = {};
};

/// A servo with its device on a thread of its own, in which Python never is. Any thread may call
/// what it has.
class RunningServo {
 public:
  /// Starts. @throws Error as opening the device, Servo and ServoThread do.
  RunningServo(std::shared_ptr<SharedScene> scene, const ServoPlan& plan);

  /// Ends the thread: zero force. Again: nothing.
  void stop();

  [[nodiscard]] bool running() const;
  /// Why the device is silent or has failed, and what the guard did; empty: nothing is wrong.
  [[nodiscard]] std::string problem() const;
  /// The steps since the last call, as far as there was room for them.
  [[nodiscard]] std::vector<Tick> ticks();
  [[nodiscard]] std::uint64_t dropped() const { return queue_.dropped(); }
  /// Moves a simulated device's hand to a place in the world, m. @throws Error for other devices.
  void move(const Eigen::Vector3d& position);

  [[nodiscard]] Servo& servo() { return *servo_; }
  [[nodiscard]] const Servo& servo() const { return *servo_; }
  [[nodiscard]] const RealtimeReport& realtime() const { return realtime_; }
  [[nodiscard]] double rate() const { return rate_; }

 private:
  void open(const ServoPlan& plan);
  void simulate(const ServoPlan& plan);

  static constexpr std::size_t kRoom = 16384;  // steps: 16 s at 1 kHz (judgement)

  std::shared_ptr<SharedScene> scene_;
  SteadyClock clock_;
  Workspace workspace_;
  ServoState::Queue queue_{kRoom};
  RemoteTarget target_;
  std::unique_ptr<TeleoperatedHand> hand_;
  std::unique_ptr<Device> simulated_;  // in simulated time, which device_ paces
  std::unique_ptr<Device> device_;
  std::unique_ptr<Servo> servo_;
  RealtimeReport realtime_;
  double rate_ = 0;                      // Hz
  mutable std::mutex mutex_;             // of the thread's end, and of who takes ticks
  std::unique_ptr<ServoThread> thread_;  // last: it uses all of the above
};

}  // namespace palpate::python
