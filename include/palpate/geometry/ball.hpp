#pragma once

#include <Eigen/Core>

namespace palpate {

/// A closed ball.
struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m
  double radius = 0;                                 ///< m
};

}  // namespace palpate
