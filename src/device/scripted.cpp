// Devices that play what is given: a trajectory, or another device at a clock's pace.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "geometry/turn.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {

void check(const Trajectory& trajectory) {
  if (trajectory.empty())
    throw Error("a trajectory without rows cannot be played: give at least one row");
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TrajectoryRow& row = trajectory[i];
    const Eigen::Quaterniond turned = row.orientation.value_or(Eigen::Quaterniond::Identity());
    if (!std::isfinite(row.time) || !row.position.allFinite() || !is_about_unit(turned) ||
        !std::isfinite(row.opening.value_or(0))) {
      throw Error(fmt::format(
          "row {} of the trajectory is not finite, or no pose: remove or correct it", i));
    }
    if (i > 0 && !(row.time > trajectory[i - 1].time)) {
      throw Error(
          fmt::format("row {} of the trajectory has t = {} s after t = {} s: times must increase",
                      i, row.time, trajectory[i - 1].time));
    }
  }
}

ScriptedDevice::ScriptedDevice(Trajectory trajectory) : rows_(std::move(trajectory)) {
  check(rows_);
  info_.name = "scripted";
  info_.maximum_force = 0;
  info_.keeps_time = true;
  info_.has_orientation = rows_.front().orientation.has_value();
  info_.has_gripper = rows_.front().opening.has_value();
  if (rows_.size() > 1) {
    info_.rate = static_cast<double>(rows_.size() - 1) / (rows_.back().time - rows_.front().time);
  }
}

DeviceState ScriptedDevice::read() noexcept {
  if (failed_) return state_;
  if (next_ == rows_.size()) {
    state_.status = DeviceState::Status::finished;
    state_.velocity.setZero();
    state_.angular_velocity.setZero();
    return state_;
  }
  const TrajectoryRow& row = rows_[next_];
  const Eigen::Quaterniond turned = row.orientation.value_or(Eigen::Quaterniond::Identity());
  if (next_ > 0) {
    const TrajectoryRow& before = rows_[next_ - 1];
    const double span = row.time - before.time;
    state_.velocity = (row.position - before.position) / span;
    state_.angular_velocity = turn_between(state_.orientation, turned) / span;
  }
  state_.time = row.time;
  state_.position = row.position;
  state_.orientation = turned;
  state_.gripper = row.opening.value_or(0);
  ++next_;
  return state_;
}

void ScriptedDevice::write(const Eigen::Vector3d& force) noexcept {
  if (failed_) return;
  if (!force.allFinite()) {
    failed_ = true;
    state_.status = DeviceState::Status::failed;
    force_.setZero();
    return;
  }
  force_ = force;
}

std::string ScriptedDevice::reason() const {
  if (!failed_) return {};
  return fmt::format(
      "the force written after t = {} s was not finite; find the error in the code that computed "
      "it",
      state_.time);
}

PacedDevice::PacedDevice(Device& device, const Clock& clock, int most_steps)
    : device_(device), clock_(clock), most_steps_(most_steps), info_(device.info()) {
  info_.keeps_time = false;
}

// Half a step of slack: steps of clock and device may coincide but for rounding.
DeviceState PacedDevice::read() noexcept {
  const double period = 1 / info_.rate;
  const double now = clock_.now();
  if (!started_) {
    started_ = true;
    state_ = device_.read();
    start_ = now - state_.time;
    return state_;
  }
  int steps = 0;
  while (!has_ended(state_.status) && state_.time + 0.5 * period <= now - start_) {
    if (++steps > most_steps_) {
      start_ = now - state_.time;
      break;
    }
    state_ = device_.read();
  }
  return state_;
}

}  // namespace palpate
