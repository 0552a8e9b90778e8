#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "palpate/servo/servo.hpp"
#include "viewer/state_message.hpp"

namespace palpate::viewer {

/// Makes the messages of one servo's state: of what happened since the message before. One thread
/// uses it.
class StateSource {
 public:
  StateSource(const Servo& servo, std::size_t device, const Eigen::Vector3d& origin)
      : servo_(servo), device_(static_cast<std::uint8_t>(device)), origin_(origin) {}

  /// `now`: s, of the host; `radius`: R, m; none: the servo made no step yet.
  [[nodiscard]] std::optional<StateMessage> next(double now, double radius, bool taken);

 private:
  [[nodiscard]] double rate(double now, std::uint64_t step);
  [[nodiscard]] double interval(const ServoState& state);
  [[nodiscard]] std::vector<Eigen::Vector3f> forces_until(std::uint64_t step);
  [[nodiscard]] std::uint32_t flags(const ServoState& state, bool taken);

  const Servo& servo_;
  std::uint8_t device_;
  Eigen::Vector3d origin_;
  std::uint64_t step_ = 0;  // of the message before
  double time_ = 0;         // of it, s
  std::uint64_t forces_seen_ = 0;
  GuardCounts counts_;
  Durations computing_;
  Durations lateness_;
  std::deque<std::pair<double, std::uint64_t>> steps_;  // when which step was the newest
};

}  // namespace palpate::viewer
