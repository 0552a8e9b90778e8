#include "field/edges.hpp"

namespace palpate {

using Eigen::Vector3d;

// f = B + (sum e h - B sum e) / V: e_i = v_i |share_i|, h_i the height above what both planes
// leave, B the smooth surface, V = sum v.
Value with_edges(const FieldPlace& place, const Value& smooth) noexcept {
  simd::EdgeSums sums;
  place.functions->edges(*place.columns, place.columns->begin_of(place.label),
                         place.columns->begin_of(place.label + 1), place.kernel == Kernel::wendland,
                         place.x, sums);
  if (!(sums.v > 0)) return smooth;
  const double inverse = 1 / place.sums().v;
  const double gain = inverse * (sums.vh - smooth.f * sums.v);
  const Vector3d grad_gain = vector(sums.grad_vh) - smooth.f * vector(sums.grad_v) -
                             sums.v * smooth.grad - gain * vector(place.sums().grad_v);
  return {smooth.f + gain, smooth.grad + inverse * grad_gain};
}

}  // namespace palpate
