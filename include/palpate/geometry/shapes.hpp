#pragma once

#include <Eigen/Core>
#include <limits>

namespace palpate {

/// A closed ball.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m
  double radius = 0;                                 ///< m
};

/// An axis-aligned box, empty until something is put in.
struct Box {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Eigen::Vector3d& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  void extend(const Box& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  [[nodiscard]] bool empty() const { return (lower.array() > upper.array()).any(); }
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    return (point.array() >= lower.array()).all() && (point.array() <= upper.array()).all();
  }
  [[nodiscard]] Eigen::Vector3d size() const { return upper - lower; }
  [[nodiscard]] Eigen::Vector3d center() const { return 0.5 * (lower + upper); }
};

}  // namespace palpate
