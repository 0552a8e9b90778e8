// Says where the nodes of a point store are.
#include "palpate/geometry/point_store.hpp"

#include <cmath>

namespace palpate {

Box PointStore::Layout::box(std::size_t node) const {
  const std::array<std::int32_t, 3>& cell = nodes[node].cell;
  const double size = std::ldexp(edge, -nodes[node].level);
  const Eigen::Vector3d at = lower + size * Eigen::Vector3d(cell[0], cell[1], cell[2]);
  return {at, at + Eigen::Vector3d::Constant(size)};
}

double PointStore::Layout::spacing_of(std::size_t node) const {
  return std::ldexp(spacing, -nodes[node].level);
}

}  // namespace palpate
