#pragma once

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// @throws Error naming the option that makes no sense, by itself or for this cloud.
void check(const PrepareOptions& options, const PointCloud& cloud);

}  // namespace palpate
