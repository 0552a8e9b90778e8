// Prepares a cloud in a core by itself: at once, without refinements.
#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"
#include "prepare/surfels.hpp"

namespace palpate {

Prepared prepare(const PointCloud& cloud, const PrepareOptions& options,
                 const Eigen::Isometry3d& T_world_sensor) {
  const Placed placed = place(cloud, options, T_world_sensor);
  return prepare_at_once(placed, options, {}, {.points_in = cloud.size()});
}

}  // namespace palpate
