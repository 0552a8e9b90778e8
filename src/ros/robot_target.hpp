#pragma once

#include <algorithm>
#include <mutex>
#include <string_view>

#include "dds/endpoint.hpp"
#include "palpate/ros/bridge.hpp"

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

/// Tells a robot where to go. While the hand is not known, its servo stands still, its button is
/// up, or no surface keeps the proxy out of things, it is told nothing, and stops by its own
/// controller's watchdog.
class RobotTarget {
 public:
  /// @throws Error when the preset is none.
  RobotTarget(const dds::Participant& participant, const RosBridgeOptions::Robot& options);

  /// `now`: s. Tells the target where one is due.
  void look(const ServoState& state, double now, const message::Time& stamp);

  /// Any thread.
  [[nodiscard]] RosBridge::RobotState state() const;

 private:
  // False: it could not be sent in time.
  bool tell(const ServoState& state, const message::Time& stamp);
  [[nodiscard]] std::string_view obstacle(const ServoState& state, double now) const;

  RosBridgeOptions::Robot options_;
  dds::Writer<message::PoseStamped> target_;
  Every due_;
  std::uint64_t step_ = 0;    // the last that was seen
  double stepped_ = 0;        // when it was new, s
  mutable std::mutex mutex_;  // of what follows
  RosBridge::RobotState told_;
};

}  // namespace palpate::ros
