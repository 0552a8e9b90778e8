#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "apps/palpate/cli/errors.hpp"
#include "geometry/rotation.hpp"

namespace palpate::app {

/// The pose of a matrix with 3 or 4 rows of 4, row by row: 12 or 16 numbers.
/// @throws UsageError when it is no rotation and translation; `what` goes into the message.
[[nodiscard]] inline Eigen::Isometry3d pose_of_matrix(const std::vector<double>& v,
                                                      const std::string& what) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(v.data());
  const Eigen::Matrix3d turn = rows.leftCols<3>();
  if (v.size() == 16 && (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1)) {
    throw UsageError(fmt::format(
        "{}: the last row is {}, {}, {}, {}; it must be 0, 0, 0, 1 (give the matrix row "
        "by row)",
        what, v[12], v[13], v[14], v[15]));
  }
  if (!is_orthogonal(turn)) {
    throw UsageError(
        fmt::format("{}: the matrix is no rotation: the first three numbers of its rows must have "
                    "length 1 and stand at right angles to one another",
                    what));
  }
  if (turn.determinant() < 0) {
    throw UsageError(fmt::format("{}: the matrix mirrors; reverse one of its axes", what));
  }
  return Eigen::Translation3d(rows.col(3)) * Eigen::Quaterniond(turn).normalized();
}

}  // namespace palpate::app
