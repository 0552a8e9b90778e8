// Separates rotations from matrices that scale, shear or mirror.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace palpate {

/// Do the rows have length 1 and stand at right angles, as far as people round numbers? NaN: no.
[[nodiscard]] inline bool is_orthogonal(const Eigen::Matrix3d& matrix) {
  constexpr double kRounded = 0.01;  // two digits; judgement
  return (matrix * matrix.transpose()).isIdentity(kRounded);
}

/// The same, and does it not mirror?
[[nodiscard]] inline bool is_rotation(const Eigen::Matrix3d& matrix) {
  return is_orthogonal(matrix) && matrix.determinant() > 0;
}

}  // namespace palpate
