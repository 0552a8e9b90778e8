// What a sample of a tool forbids, and how a list that is full makes room.
#include "tool/constraint_list.hpp"

#include <algorithm>

namespace palpate {

double ConstraintList::drop_half() noexcept {
  const auto half = all_.begin() + kCapacity / 2;
  std::nth_element(all_.begin() + static_cast<std::ptrdiff_t>(kept_), half, all_.end(),
                   [](const Constraint& a, const Constraint& b) { return a.bound > b.bound; });
  count_ = kCapacity / 2;
  return half->bound;
}

Constraint constraint_on(const Tool& tool, int sample, const Eigen::Vector3d& x,
                         const Eigen::Vector3d& normal, const Pose& pose,
                         const Metric& metric) noexcept {
  const int side = tool.samples()[static_cast<std::size_t>(sample)].side;
  Constraint constraint;
  constraint.normal << normal, (x - pose.position).cross(normal) / metric.gyration,
      0.5 * side * normal.dot(pose.orientation * tool.axis());
  constraint.sample = sample;
  return constraint;
}

}  // namespace palpate
