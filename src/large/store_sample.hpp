// Draws points of a store without reading all of it.
#pragma once

#include <Eigen/Geometry>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// Some points of a store, in its frame.
struct StoreSample {
  PointCloud all;     ///< thinned: those of the upper nodes
  PointCloud around;  ///< all that lie around some positions
};

/// At least a hundred thousand points of all of the store, and some thousand nearest ones at each
/// of 64 positions, which are spread over its points. Always the same of the same store. Nodes that
/// cannot be read are left out.
/// @throws Error when no point is left: the first that reading gave.
[[nodiscard]] StoreSample sample_of(const PointStore& store);

/// measure_facts() of the store that the sample is of.
[[nodiscard]] CloudFacts measure_facts(const StoreSample& sample, const PrepareOptions& options,
                                       const Eigen::Isometry3d& T_world_sensor);

}  // namespace palpate
