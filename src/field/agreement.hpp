#pragma once

#include <Eigen/Core>
#include <cmath>

namespace palpate {

/// How far two points' normals agree on what is outside, -1 ... 1: n_p, mirrored by the plane
/// halfway between p and q, times n_q, as if an arc joined the two; their plain product where both
/// points lie on one plane within `tolerance` (m). `way`: from p to q, or back, m.
[[nodiscard]] inline float agreement(const Eigen::Vector3f& n_p, const Eigen::Vector3f& n_q,
                                     const Eigen::Vector3f& way, float tolerance) noexcept {
  const float by_p = n_p.dot(way);
  const float by_q = n_q.dot(way);
  const float straight = n_p.dot(n_q);
  const float squared = way.squaredNorm();
  const bool one_plane = std::abs(by_p) <= tolerance && std::abs(by_q) <= tolerance;
  return one_plane || !(squared > 0) ? straight : straight - 2 * by_p * by_q / squared;
}

}  // namespace palpate
