#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace palpate::sensor {

/// A pose from numbers that people and programs wrote down: rounded, so that rotations are a little
/// off; these are set right. Nothing when they are far off (1 %), or beyond 10^6 m.
[[nodiscard]] std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& place,
                                                     const Eigen::Quaterniond& rotation);
[[nodiscard]] std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& place,
                                                     const Eigen::Matrix3d& rotation);

}  // namespace palpate::sensor
