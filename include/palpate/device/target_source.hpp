#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

namespace palpate {

/// Returns step by step the target of a simulated device's hand, for motions that are unknown in
/// advance.
class TargetSource {
 public:
  /// A position that the hand pulls towards, and what it does there.
  struct Target {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, device frame
    std::uint32_t buttons = 0;                           ///< bit k: button k is down
    /// The hand pulls with no more, N, nor with more than its SimulatedDeviceOptions allow; above
    /// 0.
    double maximum_force = std::numeric_limits<double>::infinity();
    /// Where the hand pulls the device's wrist to, if it has one: from the tool's axes to the
    /// device's, of unit length.
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    double opening = 0;  ///< how far the hand has a gripper open, m
  };

  virtual ~TargetSource() = default;

  /// The target at `time`, s on the device's clock, which grows from call to call; the device is at
  /// `position` now, m, device frame. Called on the servo's thread: no allocation, lock, throw or
  /// system call. A target that is not finite makes the device fail.
  [[nodiscard]] virtual Target target(double time, const Eigen::Vector3d& position) noexcept = 0;

 protected:
  TargetSource() = default;
  TargetSource(const TargetSource&) = default;
  TargetSource& operator=(const TargetSource&) = default;
};

}  // namespace palpate
