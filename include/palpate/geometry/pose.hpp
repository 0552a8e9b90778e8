// Where a tool is that can turn, and what acts on it.
#pragma once

#include <Eigen/Geometry>

namespace palpate {

/// Where a tool's handle is, how the tool is turned, and how far its gripper is open.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the handle, m, world
  /// Rotation from the tool's axes to the world's, of unit length.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// Between the fingers of a gripper, m, at least 0; 0 for other tools.
  double opening = 0;
};

/// Acts on a hand that holds a tool; in the world's axes.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< about the handle, N m
  double grip = 0;                                   ///< on the opening, N; above 0 it opens
};

}  // namespace palpate
