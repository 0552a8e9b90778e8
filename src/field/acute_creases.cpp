#include "field/acute_creases.hpp"

#include "field/smooth_step.hpp"

namespace palpate {
namespace {

constexpr double kDepth = 0.2;    // of R: twice what a scan's creases need, of two sheets' mean
constexpr double kSquare = 0.7;   // |Nb|^2 where two equal sheets meet at 114 degrees
constexpr double kHollow = 0.01;  // h from which on a surface is concave beyond doubt

}  // namespace

Value crease_closure(const FieldPlace& place) noexcept {
  const Oriented square = normal_square(*place.sums);
  const SmoothStep facing = smooth_step(kSquare - square.f, 0, kSquare);
  if (facing.value <= 0) return {};
  const Oriented bulge = convexity(*place.sums);
  const Value& radius = place.radius;
  const double inverse = -place.sign / radius.f;
  const double h = inverse * bulge.f;
  const SmoothStep hollow = smooth_step(h, 0, kHollow);
  if (hollow.value <= 0) return {};

  const double by_h = facing.value * hollow.slope;
  Oriented share;
  add(share, -facing.slope * hollow.value, square);
  add(share, by_h * inverse, bulge);
  double sum[3];
  place.functions->gradient(*place.columns, place.x, share.b, sum);
  const double closed = facing.value * hollow.value;
  return {kDepth * radius.f * closed,
          kDepth * (radius.f * (share.base + vector(sum)) + (closed - by_h * h) * radius.grad)};
}

}  // namespace palpate
