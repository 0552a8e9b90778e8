#include "field/acute_creases.hpp"

#include "field/smooth_step.hpp"

namespace palpate {
namespace {

constexpr double kClosed = 0.2;   // of R; half of it closes a scan's creases, not all of two sheets
constexpr double kFacing = 0.7;   // |Nb|^2 where two equal sheets meet at 114 degrees
constexpr double kHollow = 0.01;  // h from which on a surface is concave beyond doubt

}  // namespace

Value crease_closure(const FieldPlace& place) noexcept {
  const Oriented square = normal_square(place.sums());
  const SmoothStep facing = smooth_step(kFacing - square.f, 0, kFacing);
  if (facing.value <= 0) return {};
  const Oriented bulge = convexity(place.sums());
  const Value& radius = place.radius;
  const double inverse = -1 / radius.f;
  const double h = inverse * bulge.f;
  const SmoothStep hollow = smooth_step(h, 0, kHollow);
  if (hollow.value <= 0) return {};

  const double by_h = facing.value * hollow.slope;
  Oriented share;
  add(share, -facing.slope * hollow.value, square);
  add(share, by_h * inverse, bulge);
  const double closed = facing.value * hollow.value;
  return {kClosed * radius.f * closed,
          kClosed * (radius.f * (share.base + place.gradient(share.b)) +
                     (closed - by_h * h) * radius.grad)};
}

}  // namespace palpate
