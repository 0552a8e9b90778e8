// Heights above two planes at once, for points beside edges. Included after sums.inl by one source
// file for each level, in an anonymous namespace as that.

#include "field/simd/sums.hpp"

namespace palpate::simd {
namespace {

// The larger of h above a point's own plane and k above the one beyond the edge, or in a crease the
// smaller, with how much of its slope is k's: (h + k) / 2 + |k - h| / 2, rounded where they cross.
struct Larger {
  Lanes height;
  Lanes of_k;
};
[[gnu::always_inline]] inline Larger larger(const Lanes& h, const Lanes& k, const Lanes& width) {
  const Lanes d = k - h;
  const Lanes t = positive(width - absolute(d));
  const Lanes past = absolute(d + width) - absolute(d - width);  // 2 width beyond the rounding
  const Lanes inverse = 1.0 / width;
  return {0.5 * (h + k + absolute(d)) + 0.25 * inverse * t * t, 0.5 + 0.25 * inverse * past};
}

// The widths that edges and creases are rounded over, R_i, so that heights have gradients.
constexpr double kRoundEdge = 0.005;   // judgement (docs/method.md 2.8)
constexpr double kRoundCrease = 0.05;  // judgement (docs/method.md 2.8)
// m; points that pad lanes have no radius, and 1 / width must be finite.
constexpr double kNoWidth = 1e-12;

template <bool kWendland>
void edges(const Columns& c, std::uint32_t begin, std::uint32_t end, const double x[3],
           EdgeSums& out) noexcept {
  Lanes v{};
  Lanes vh{};
  Vector grad_v;
  Vector grad_vh;
  for (std::uint32_t k = begin; k < end; ++k) {
    const std::uint32_t i = c.near[k];
    const Lanes signed_share = load(c.edge_share + i);
    const Lanes share = absolute(signed_share);
    if (!(sum(share) > 0)) continue;
    const Lanes sign = (Lanes)(((Mask)signed_share & kSign) | (Mask)same(1));
    const Vector q = offsets(c, i, x);
    const Vector n = load3(c.normal, i);
    const Vector m = load3(c.edge_normal, i);
    const Lanes round = sign < 0.0 ? same(kRoundCrease) : same(kRoundEdge);
    const Lanes width = round * load(c.radius + i) + kNoWidth;
    const Lanes beyond = load(c.edge_height + i) - dot(m, q);
    const Larger both = larger(-sign * dot(n, q), sign * beyond, width);
    const Lanes height = sign * both.height;
    const Lanes trust = share * load(c.confidence + i);
    const Lanes w = load(c.weight + i) * kernel<kWendland>(dot(q, q) * load(c.inverse_r2 + i)).w;
    const Lanes vi = kScaleW<kWendland> * (w * trust);
    const Lanes slope = load(c.slope + i) * trust;
    v += vi;
    vh += vi * height;
    add(grad_v, slope, q);
    add(grad_vh, slope * height, q);
    add(grad_vh, vi * (1.0 - both.of_k), n);
    add(grad_vh, vi * both.of_k, m);
  }
  out.v = sum(v);
  out.vh = sum(vh);
  store(grad_v, 1, out.grad_v);
  store(grad_vh, 1, out.grad_vh);
}

void edges_of(const Columns& c, std::uint32_t begin, std::uint32_t end, bool wendland,
              const double x[3], EdgeSums& out) noexcept {
  wendland ? edges<true>(c, begin, end, x, out) : edges<false>(c, begin, end, x, out);
}

}  // namespace
}  // namespace palpate::simd
