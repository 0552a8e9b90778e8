#include "sensor/rigid.hpp"

#include <cmath>

namespace palpate::sensor {
namespace {

constexpr double kOff = 0.01;
constexpr double kFarthestOrigin = 1e6;  // m

bool is_place(const Eigen::Vector3d& place) {
  return place.allFinite() && place.cwiseAbs().maxCoeff() <= kFarthestOrigin;
}

Eigen::Isometry3d joined(const Eigen::Vector3d& place, const Eigen::Quaterniond& rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = place;
  return pose;
}

}  // namespace

std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& place,
                                       const Eigen::Quaterniond& rotation) {
  const bool good = rotation.coeffs().allFinite() && std::abs(rotation.norm() - 1) <= kOff;
  if (!good || !is_place(place)) return {};
  return joined(place, rotation);
}

std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& place,
                                       const Eigen::Matrix3d& rotation) {
  if (!rotation.allFinite() || !is_place(place)) return {};
  const Eigen::Matrix3d error = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  if (error.cwiseAbs().maxCoeff() > 2 * kOff || rotation.determinant() < 0) return {};
  return joined(place, Eigen::Quaterniond(rotation));
}

}  // namespace palpate::sensor
