#pragma once

#include <cstddef>

#include "palpate/device/device.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate {

/// Plays a trajectory, one row a step, in simulated time. The hand goes where the trajectory goes
/// whatever the force; velocity is that from the row before.
class ScriptedDevice final : public Device {
 public:
  /// @throws Error when the trajectory is empty, not finite, or its times do not grow.
  explicit ScriptedDevice(Trajectory trajectory);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override;
  [[nodiscard]] std::string reason() const override;

  /// The force of the last write(), N, device frame.
  [[nodiscard]] const Eigen::Vector3d& force() const noexcept { return force_; }

 private:
  Trajectory rows_;
  DeviceInfo info_;
  DeviceState state_;
  std::size_t next_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  bool failed_ = false;
};

/// @throws Error that names the row when a trajectory is empty, not finite, or its times do not
/// grow strictly.
void check(const Trajectory& trajectory);

}  // namespace palpate
