#pragma once

#include <Eigen/Geometry>

namespace palpate {

/// Where a device stands in the world and how much its motion is magnified.
///
/// Positions and velocities are rotated, magnified by `scale` and, positions, moved. Forces are
/// only rotated: a newton that a proxy computes is a newton that the hand feels. It follows that
///  - a surface of K N/m in the world is felt as scale * K N/m by the hand; to be felt as K it has
///    to be given K / scale (felt_stiffness() tells);
///  - work done on the hand is the world's work F . dh divided by `scale`; its sign, on which
///    passivity rests, is the same in both.
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
