#include "field/sharp_edges.hpp"

#include "field/smooth_step.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// a from which on edges are sharpened, and from which on in full. Below the first, what noise a
// good fit leaves makes planes look convex; they need not pay for it.
constexpr double kFrom = 0.002;
constexpr double kFull = 0.05;

/// sum v s / sum v.
Value share_of(const FieldPlace& place, std::uint32_t places) noexcept {
  const double uniform = place.columns->uniform_sharp;
  if (uniform >= 0) return {uniform, Vector3d::Zero()};
  simd::Share share;
  place.functions->share(*place.columns, places, place.x, share);
  const double sigma = share.sv / place.sums().v;
  return {sigma, (vector(share.grad_sv) - sigma * vector(place.sums().grad_v)) / place.sums().v};
}

/// b_i = pull . (n_i - n) / V: how a sum moves with the mean normal n of the points before.
simd::Linear through_normal(const Vector3d& pull, const Vector3d& n, double v) noexcept {
  simd::Linear b{};
  assign(b.alpha, pull / v);
  b.delta = -pull.dot(n) / v;
  return b;
}

/// RIMLS: two rounds of weighing the points by how near their normals are to the mean normal. The
/// gradient is followed back through both.
Oriented robust(const FieldPlace& place, std::uint32_t places) noexcept {
  const simd::Functions& f = *place.functions;
  const simd::Columns& c = *place.columns;
  const Vector3d n0 = vector(place.sums().vn) / place.sums().v;
  simd::Moments first;
  f.robust(c, places, place.x, n0.data(), 0, first);
  const Vector3d n1 = vector(first.vn) / first.v;
  simd::Moments second;
  f.robust(c, places, place.x, n1.data(), 1, second);

  Oriented result = balanced(second);
  simd::Pull pull;
  f.pull(c, places, place.x, n1.data(), 1, result.b, pull);
  result.base += vector(pull.place);
  const simd::Linear by_n1 = through_normal(vector(pull.normal), n1, first.v);
  f.pull(c, places, place.x, n0.data(), 0, by_n1, pull);
  result.base += vector(pull.place);
  result.b = through_normal(vector(pull.normal), n0, place.sums().v);
  return result;
}

Value finish(const FieldPlace& place, const Oriented& oriented) noexcept {
  return {oriented.f, oriented.base + place.gradient(oriented.b)};
}

}  // namespace

Value sharp_balanced(const FieldPlace& place) noexcept {
  const Oriented mean = balanced(place.sums());
  const Oriented bulge = convexity(place.sums());
  const double inverse = 1 / place.radius.f;
  const double a = bulge.f * inverse;
  if (a <= kFrom) return finish(place, mean);

  const simd::Columns& c = *place.columns;
  const std::uint32_t places =
      place.functions->near(c, c.begin_of(place.label), c.begin_of(place.label + 1),
                            place.kernel == Kernel::wendland, place.x);
  const Value sigma = share_of(place, places);
  const SmoothStep open = smooth_step(a, kFrom, kFull - kFrom);
  const Oriented sharp = robust(place, places);
  const double opening = sigma.f * open.value;
  const double gain = sharp.f - mean.f;
  const double by_a = gain * sigma.f * open.slope;
  Oriented result;
  add(result, 1 - opening, mean);
  add(result, opening, sharp);
  add(result, by_a * inverse, bulge);
  result.f = mean.f + opening * gain;
  result.base += gain * open.value * sigma.grad - by_a * a / place.radius.f * place.radius.grad;
  return finish(place, result);
}

}  // namespace palpate
