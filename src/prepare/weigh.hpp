// The step of prepare() that weighs points.
#pragma once

#include <cstddef>
#include <vector>

#include "palpate/prepare/prepare.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/weights.hpp"

namespace palpate {

struct Weights {
  std::vector<float> values;  ///< a_i in sorted order; 0: noise put the point there
  std::size_t speckle = 0;    ///< how many are 0
};

/// Density weights (docs/method.md 2.2) by the `sums` of the radii, by how many points each stands
/// for, and 0 for speckle and strays, which stay in the index.
[[nodiscard]] Weights weigh(const Sampling& sampling, const Radii& radii, const WeightSums& sums,
                            const PrepareOptions& options);

}  // namespace palpate
