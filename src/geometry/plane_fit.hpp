#pragma once

#include <Eigen/Core>

namespace palpate::detail {

/// The upper triangle of a symmetric 3x3 matrix.
struct Symmetric {
  double xx = 0;
  double xy = 0;
  double xz = 0;
  double yy = 0;
  double yz = 0;
  double zz = 0;
};

/// Least-squares plane of a point set from its covariance.
struct PlaneFit {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit; zero where undefined
  double smallest = 0;                               ///< eigenvalues of the covariance
  double middle = 0;
  double largest = 0;
};

/// Eigenvalues and the eigenvector of the smallest of a positive semi-definite matrix, in closed
/// form. Finite for every finite matrix.
[[nodiscard]] PlaneFit fit_plane(const Symmetric& covariance) noexcept;

}  // namespace palpate::detail
