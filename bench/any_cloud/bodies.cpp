// Closed bodies that hands poke, and scans of them.

#include "any_cloud/bodies.hpp"

#include "any_cloud/worked_shapes.hpp"

namespace palpate::any_cloud {

using Eigen::Vector3d;

void scan(Draft& draft, const Body& body) {
  draft.truth = body.shape;
  draft.surface(body.shape, -body.reach, body.reach);
}

Body draw_body(Draft& draft) {
  const Vector3d end(10, 0, 0);
  switch (draft.random.bits() % 6) {
    case 0:
      return {rod(-end, end, 7), Vector3d(18, 8, 8)};
    case 1:
      return {box(Vector3d::Zero(), {30, 24, 18}), Vector3d(16, 13, 10)};
    case 2:
      return {torus(15, 6), Vector3d(22, 22, 7)};
    case 3:
      return {unite(rod(end, 1.1 * end, 8), unite(rod(-end, -1.1 * end, 8), rod(-end, end, 4))),
              Vector3d(20, 9, 9)};
    case 4:
      return {relief({15, 15, 7}, 12, 1.5), Vector3d(16, 16, 10)};
    default:
      return {cup(15, 9), Vector3d::Constant(16)};
  }
}

}  // namespace palpate::any_cloud
