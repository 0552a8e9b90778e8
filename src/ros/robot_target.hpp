#pragma once

#include <algorithm>
#include <mutex>
#include <optional>
#include <string_view>

#include "dds/endpoint.hpp"
#include "palpate/ros/bridge.hpp"
#include "ros/robot_guide.hpp"

namespace palpate::ros {

/// Is something that is to happen `rate` times a second due?
class Every {
 public:
  explicit Every(double rate) : period_(1 / rate) {}

  bool due(double now) {
    if (now < next_) return false;
    next_ = std::max(next_ + period_, now);
    return true;
  }

 private:
  double period_;
  double next_ = 0;
};

/// Rate at which a bridge has to check for news, Hz: enough for the robot's guide.
[[nodiscard]] double look_rate(const RosBridgeOptions& options);

/// Sends targets to a robot. It sends none while there are no data from the hand, its servo makes
/// no steps, its button is up, or the guide lets the robot wait: the robot then holds its last
/// target, or stops by its own controller's watchdog.
class RobotTarget {
 public:
  /// Scene and servo outlive it. @throws Error when the preset is none, or a source of the
  /// options, and for a gripper.
  RobotTarget(const dds::Participant& participant, const RosBridgeOptions::Robot& options,
              const Scene& scene, const Servo& servo);

  /// `now`: s, on the clock of the sources' stamps; some hundred times a second. Sends the target
  /// where one is due.
  void look(double now, const message::Time& stamp);

  /// Any thread.
  [[nodiscard]] RosBridge::RobotState state() const;

 private:
  [[nodiscard]] std::string_view objection(const ServoState& state, double now);
  [[nodiscard]] RobotGuide::Answer decide(const ServoState& state, double now);
  // False: it could not be sent in time.
  bool send(const Pose& target, const message::Time& stamp);
  void count(const RobotGuide::Answer& answer, double now);

  RosBridgeOptions::Robot options_;
  const Servo& servo_;
  RobotGuide guide_;
  dds::Writer<message::PoseStamped> target_;
  Every due_;
  std::uint64_t step_ = 0;       // the last that was seen
  double stepped_ = 0;           // when it was new, s
  bool up_ = true;               // is the dead man's button?
  std::optional<Pose> at_ = {};  // the last target that was sent, world
  double counted_ = 0;           // up to when waits are, s; 0: from now on
  mutable std::mutex mutex_;     // of what follows
  RosBridge::RobotState state_;
};

}  // namespace palpate::ros
