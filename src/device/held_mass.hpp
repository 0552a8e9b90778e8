// The mass of a simulated device, and the hand that holds it.
#pragma once

#include <Eigen/Core>

#include "palpate/device/simulated.hpp"

namespace palpate {

/// A mass on the hand's spring and damper, with dry friction. Moves exactly between stops and
/// starts. Real-time but for construction.
struct HeldMass {
  /// `options` outlive it.
  explicit HeldMass(const SimulatedDeviceOptions& options);

  /// A step; `push` is at its beginning, the device's `force` in it is held (N).
  void advance(const Eigen::Vector3d& force, const Eigen::Vector3d& push,
               const Eigen::Vector3d& push_rate) noexcept;
  // Parts of that.
  void slide(double duration, Eigen::Vector3d push, const Eigen::Vector3d& push_rate) noexcept;
  void flow(const Eigen::Matrix4d& transition, const Eigen::Vector3d& push,
            const Eigen::Vector3d& push_rate) noexcept;

  const SimulatedDeviceOptions& options;
  Eigen::Matrix4d generator;
  Eigen::Matrix4d whole_step;  // its exponential over one step
  Eigen::Matrix4d part_step;   // ... and over 1/16 of one
  Eigen::Vector3d position;
  Eigen::Vector3d velocity;
  double work = 0;  // that the device's force has done, J
};

}  // namespace palpate
