// Finds the nearest point that up to three planes through the origin allow.
#include "rivals/half_spaces.hpp"

#include <Eigen/Geometry>

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr double kSlack = 1e-12;     // share of the way; judgement: rounding
constexpr double kParallel = 1e-18;  // squared sine; judgement: rounding of unit normals

bool allowed(std::span<const Vector3d> normals, const Vector3d& x, double slack) {
  for (const Vector3d& n : normals) {
    if (n.dot(x) < -slack) return false;
  }
  return true;
}

}  // namespace

// The nearest point lies on none, one or two of the planes, or at the origin: all are tried.
Vector3d nearest_allowed(std::span<const Vector3d> normals, const Vector3d& goal) {
  const double slack = kSlack * goal.norm();
  if (allowed(normals, goal, slack)) return goal;
  Vector3d best = Vector3d::Zero();
  double best_way = goal.squaredNorm();
  const auto offer = [&](const Vector3d& x) {
    const double way = (goal - x).squaredNorm();
    if (way >= best_way || !allowed(normals, x, slack)) return;
    best = x;
    best_way = way;
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    offer(goal - normals[i] * normals[i].dot(goal));
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      const Vector3d edge = normals[i].cross(normals[j]);
      if (edge.squaredNorm() > kParallel) offer(edge * (edge.dot(goal) / edge.squaredNorm()));
    }
  }
  return best;
}

}  // namespace palpate::rivals
