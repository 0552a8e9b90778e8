#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

namespace palpate {

/// A way from place to place that was looked at.
struct FreeWay {
  std::vector<Eigen::Vector3d> positions;
  bool clear = false;  ///< nothing is in it
};

/// The arc from a to b that begins and ends in the direction of `rise`, and goes up by 3/4 of it,
/// in 16 to `most` pieces of some `piece`, m. It is clear where nothing is nearer than that.
/// `distance` of a position: to what is nearest, m.
template <class Distance>
[[nodiscard]] FreeWay arc(const std::pair<Eigen::Vector3d, Eigen::Vector3d>& ends,
                          const Eigen::Vector3d& rise, double piece, double most,
                          const Distance& distance) {
  const auto& [a, b] = ends;
  const double length = (b - a).norm() + 1.5 * rise.norm();
  const int pieces = static_cast<int>(std::clamp(length / piece, 16.0, most));
  FreeWay way;
  Eigen::Vector3d seen = a;
  double free = 0;  // around it
  for (int i = 0; i <= pieces; ++i) {
    const double u = static_cast<double>(i) / pieces;
    const Eigen::Vector3d position = a + u * u * (3 - 2 * u) * (b - a) + 3 * u * (1 - u) * rise;
    way.positions.push_back(position);
    if ((position - seen).norm() < free) continue;
    seen = position;
    free = distance(position) - piece;
    if (free <= 0) return way;
  }
  way.clear = true;
  return way;
}

}  // namespace palpate
