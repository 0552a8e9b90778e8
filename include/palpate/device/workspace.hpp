#pragma once

#include <Eigen/Geometry>

namespace palpate {

/// Where a device's frame is in the world and how much its motion is magnified.
///
/// Positions and velocities are rotated and multiplied by `scale`; positions are also translated.
/// Forces are only rotated: a newton that a proxy computes is a newton that the hand feels. Hence
///  - the hand feels a surface of K N/m in the world as scale * K N/m (felt_stiffness()); for it to
///    feel K, give the surface K / scale;
///  - work done on the hand is the world's work F . dh divided by `scale`; its sign, which
///    passivity depends on, is the same in both.
struct Workspace {
  Eigen::Isometry3d T_world_device = Eigen::Isometry3d::Identity();  ///< pose of the device's frame
  double scale = 1;  ///< metres in the world for one metre of the device; > 0

  [[nodiscard]] Eigen::Vector3d position_to_world(const Eigen::Vector3d& device) const noexcept {
    return T_world_device * Eigen::Vector3d(scale * device);
  }
  [[nodiscard]] Eigen::Vector3d position_to_device(const Eigen::Vector3d& world) const noexcept {
    return T_world_device.linear().transpose() * (world - T_world_device.translation()) / scale;
  }
  [[nodiscard]] Eigen::Vector3d velocity_to_world(const Eigen::Vector3d& device) const noexcept {
    return T_world_device.linear() * Eigen::Vector3d(scale * device);
  }
  [[nodiscard]] Eigen::Quaterniond orientation_to_world(
      const Eigen::Quaterniond& device) const noexcept {
    return Eigen::Quaterniond(T_world_device.linear()) * device;
  }
  [[nodiscard]] Eigen::Vector3d force_to_device(const Eigen::Vector3d& world) const noexcept {
    return T_world_device.linear().transpose() * world;
  }
  /// The stiffness that the hand feels, N/m, of a surface with `world` N/m.
  [[nodiscard]] double felt_stiffness(double world) const noexcept { return scale * world; }
};

}  // namespace palpate
