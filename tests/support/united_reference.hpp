#pragma once

#include <algorithm>
#include <vector>

#include "field/formulas.hpp"
#include "palpate/field/field_options.hpp"
#include "support/dual.hpp"

namespace palpate::test {

/// Sums of one source's points.
struct OwnSums {
  Dual w, wr;    // sum w, sum w R
  Dual v;        // sum w c
  DualVector n;  // sum v n
  Dual nq;       // sum v n . (p - x)
};

/// The shift of united_shift(), with gradients that carry themselves.
inline Dual united_shift(const std::vector<OwnSums>& sources, const Dual& radius, Kernel kernel) {
  Dual v, by_weight, covers, by_cover;
  DualVector normal;
  for (const OwnSums& own : sources) v = v + own.v;
  int count = 0;
  for (const OwnSums& own : sources) {
    if (!(own.v.v > 1e-9 * v.v)) continue;
    ++count;
    const Dual height = -1.0 * (own.nq / own.v);
    const Dual eta = abs(height) / radius;
    const Dual phi{plane_threshold(kernel, eta.v),
                   eta.v < 1 ? (plane_threshold_slope(kernel, eta.v) * eta.g).eval()
                             : Eigen::Vector3d::Zero().eval()};
    const Dual mean_radius = own.wr / own.w;
    const Dual r2 = mean_radius * mean_radius;
    const Dual cover = own.v / (sqrt(phi * phi + constant(0.01)) * r2 * r2);
    const Dual length = sqrt(dot(own.n, own.n));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      normal[axis] = normal[axis] + cover * (own.n[axis] / length);
    }
    by_weight = by_weight + own.v / v * height;
    by_cover = by_cover + cover * height;
    covers = covers + cover;
  }
  if (count < 2) return {};
  const Dual coherence = sqrt(dot(normal, normal)) / covers;
  Dual u = (1 / 0.015) * (coherence - constant(0.98));
  if (u.v <= 0) return {};
  if (u.v >= 1) u = constant(1);
  return u * u * (constant(3) - 2 * u) * (by_cover / covers - by_weight);
}

}  // namespace palpate::test
