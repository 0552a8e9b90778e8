#pragma once

// Windows of blocks and the fits to them, four windows side by side. Everything stands
// in an anonymous namespace: code for a newer processor must never stand in for an older one's.

#include <cstring>

#include "depth/simd/fits.hpp"

namespace palpate::simd {
namespace {

constexpr int kLanes = 4;  // doubles in 256 bits
typedef double Doubles __attribute__((vector_size(kLanes * sizeof(double))));
typedef long long Mask __attribute__((vector_size(kLanes * sizeof(double))));

[[gnu::always_inline]] inline Doubles load(const double* from) {
  Doubles v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
[[gnu::always_inline]] inline Doubles same(double value) {
  return value - Doubles{};
}
[[gnu::always_inline]] inline Doubles larger(const Doubles& a, const Doubles& b) {
  return a > b ? a : b;
}

[[gnu::always_inline]] inline Doubles absolute(const Doubles& v) {
  return larger(v, -v);
}

inline bool any(const Mask& mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

inline Doubles lanes(const int numbers[kLanes], int factor = 1) {
  return Doubles{double(numbers[0]), double(numbers[1]), double(numbers[2]), double(numbers[3])} *
         double(factor);
}

// Four rows of numbers become four columns.
struct Four {
  Doubles v[4];
};
[[gnu::always_inline]] inline Four transpose(const Doubles& a, const Doubles& b, const Doubles& c,
                                             const Doubles& d) {
  const Doubles ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Doubles ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Doubles cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Doubles cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {{__builtin_shufflevector(ab02, cd02, 0, 1, 4, 5),
           __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5),
           __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7),
           __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7)}};
}

// Moments of a window along one axis: n = 2 half + 1 blocks with mean square mu =
// (n^2 - 1) / 12 and spread of squares ku = (n^2 - 1) (n^2 - 4) / 180.
struct Extent {
  double per_n, per_mu, per_ku, mu;
};
struct Extents {
  Extent of[kLargestWindow + 1];
  constexpr Extents() : of{} {
    for (int half = 0; half <= kLargestWindow; ++half) {
      const double n = 2 * half + 1;
      const double mu = (n * n - 1) / 12;
      const double ku = mu * (n * n - 4) / 15;
      of[half] = {1 / n, half > 0 ? 1 / mu : 0, half > 0 ? 1 / ku : 0, mu};
    }
  }
};
constexpr Extents kExtents;

// Moments of four windows, as fits need them.
struct Shape {
  Doubles per_n, per_mu, per_mv, per_ku, per_kv, mu, mv, area;
  Mask few_u, few_v;  // columns, rows are three, which any parabola goes through
};

[[gnu::always_inline]] inline Four extents(const int half[kLanes]) {
  const auto row = [&](int l) { return load(&kExtents.of[half[l]].per_n); };
  return transpose(row(0), row(1), row(2), row(3));
}

[[gnu::always_inline]] inline Shape shape(const int half_u[kLanes], const int half_v[kLanes]) {
  const Four u = extents(half_u);
  const Four v = extents(half_v);
  Doubles area;
  Mask few_u;
  Mask few_v;
  for (int l = 0; l < kLanes; ++l) {
    area[l] = (2 * half_u[l] + 1) * (2 * half_v[l] + 1);
    few_u[l] = half_u[l] <= 1 ? -1 : 0;
    few_v[l] = half_v[l] <= 1 ? -1 : 0;
  }
  return {u.v[0] * v.v[0], u.v[1], v.v[1], u.v[2], v.v[2], u.v[3], v.v[3], area, few_u, few_v};
}

// The same for four windows of one size.
[[gnu::always_inline]] inline Shape shape(int half_u, int half_v) {
  const Extent& u = kExtents.of[half_u];
  const Extent& v = kExtents.of[half_v];
  const int area = (2 * half_u + 1) * (2 * half_v + 1);
  return {same(u.per_n * v.per_n),
          same(u.per_mu),
          same(v.per_mu),
          same(u.per_ku),
          same(v.per_ku),
          same(u.mu),
          same(v.mu),
          same(area),
          half_u <= 1 ? ~Mask{} : Mask{},
          half_v <= 1 ? ~Mask{} : Mask{}};
}

// Sums over four windows.
struct Moments {
  Doubles low[kLanes];   // one window each: r, ru, rv, ruu
  Doubles high[kLanes];  // ruv, rvv, rr, counts
  Doubles u, v;          // of the windows' middles, from the table's

  // A window that is not inside the table counts as holes. `column`, `row` in blocks of the table.
  [[gnu::always_inline]] inline void set(const WindowTable& table, int lane, int column, int row,
                                         int half_u, int half_v) {
    const std::ptrdiff_t stride = table.columns + 1;
    const bool inside = column >= half_u && row >= half_v && column + half_u < table.columns &&
                        row + half_v < table.rows;
    const std::ptrdiff_t offset = inside ? (row - half_v) * stride + (column - half_u) : 0;
    const std::ptrdiff_t across = inside ? kWindowSums * (2 * half_u + 1) : 0;
    const std::ptrdiff_t down = inside ? kWindowSums * stride * (2 * half_v + 1) : 0;
    const double* top = table.sums + kWindowSums * offset;
    const double* bottom = top + down;
    low[lane] = (load(bottom + across) - load(bottom)) - (load(top + across) - load(top));
    high[lane] =
        (load(bottom + across + 4) - load(bottom + 4)) - (load(top + across + 4) - load(top + 4));
  }
};

// Fits over full windows, in units of kRhoUnits and blocks from the middle: 1, u, v, u v, u^2 - mu,
// v^2 - mv are orthogonal there.
struct Fits {
  Shape shape;
  Doubles m, cu, cv, cuv, cuu, cvv;
  Doubles variance;  // of one block
  double shared;     // FitInput's
  Mask full;         // no hole
  Mask torn;         // the three rows or columns need not be one surface: a parabola shows nothing
  Mask affine;       // full, and the noise explains what the affine fit leaves
  Mask quadratic;    // or the quadratic one
};

// Is chi^2 = left / variance one that `degrees` of freedom may have: within three deviations?
// `together`: by how much the variance of a sum of squares grows as neighbours err together.
[[gnu::always_inline]] inline Mask explained(const Doubles& left, const Doubles& variance,
                                             const Doubles& degrees, double together) {
  const Doubles excess = left - degrees * variance;
  return (excess <= 0.0) | (excess * excess <= 18.0 * together * degrees * variance * variance);
}

[[gnu::always_inline]] inline Doubles noise_sigma(const double noise[3], const Doubles& rho) {
  return kRhoUnits * noise[2] + rho * (noise[1] + rho * (noise[0] / kRhoUnits));
}

// FitInput::shared of terms of a degree.
template <class T>
[[gnu::always_inline]] inline T shared_over(double shared, int degree, const T& per_n) {
  return shared / (1.0 + kUnseenShare[degree] * (shared - 1) * per_n);
}

// What paraboloids add to the fits: `left` and `sigma` of planes, sums without those of planes.
[[gnu::always_inline]] inline void bend(const FitInput& input, const Doubles& left,
                                        const Doubles& sigma, double together, const Doubles& buv,
                                        const Doubles& buu, const Doubles& bvv, Fits& f) {
  const Shape& g = f.shape;
  f.cuv = buv * (g.per_n * g.per_mu * g.per_mv);
  f.cuu = buu * (g.per_n * g.per_ku);
  f.cvv = bvv * (g.per_n * g.per_kv);
  const Doubles bent = f.cuv * buv + f.cuu * buu + f.cvv * bvv;
  const Doubles bend = f.variance * shared_over(input.shared, 2, g.per_n);
  f.affine &= bent <= 12.0 * bend;
  const Doubles same_surface = input.close * sigma + input.steep * f.m;
  f.torn = (g.few_u & (absolute(f.cu) + absolute(f.cuu) > same_surface)) |
           (g.few_v & (absolute(f.cv) + absolute(f.cvv) > same_surface));
  f.quadratic = f.full & ~f.torn & explained(left - bent, f.variance, g.area - 6.0, together);
}

// `planes`: only planes count; where noise explains none, terms of the second degree are not set.
[[gnu::always_inline]] inline Fits fit(const FitInput& input, const Shape& g, const Moments& s,
                                       bool planes = false) {
  Fits f;
  f.shape = g;
  const Four low = transpose(s.low[0], s.low[1], s.low[2], s.low[3]);
  const Four high = transpose(s.high[0], s.high[1], s.high[2], s.high[3]);
  const auto& [r, su, sv, suu] = low.v;
  const auto& [suv, svv, srr, counts] = high.v;
  const Doubles bu = su - s.u * r;
  const Doubles bv = sv - s.v * r;
  f.m = r * g.per_n;
  f.cu = bu * (g.per_n * g.per_mu);
  f.cv = bv * (g.per_n * g.per_mv);
  const Doubles weights = counts - kBlock * g.area;  // negative where there is a hole
  const Doubles sigma = noise_sigma(input.noise, f.m);
  // The rounding to whole units is noise too.
  const Doubles variance = larger(sigma * sigma * (weights * g.per_n * (1. / 3)), same(1. / 12));
  f.variance = variance;
  f.shared = input.shared;
  const Doubles left = srr - r * f.m - f.cu * bu - f.cv * bv;
  // A Gaussian's square is half as wide, so squares share half of what the errors do.
  const double together = input.shared > 2 ? 0.5 * input.shared : 1;
  f.full = weights >= 0.0;
  f.affine = f.full & explained(left, variance, g.area - 3.0, together);
  if (planes && !any(f.affine)) {
    f.torn = f.quadratic = Mask{};
    return f;
  }
  const Doubles buv = suv - s.u * sv - s.v * bu;
  const Doubles buu = suu - s.u * (su + bu) - g.mu * r;
  const Doubles bvv = svv - s.v * (sv + bv) - g.mv * r;
  bend(input, left, sigma, together, buv, buu, bvv, f);
  return f;
}

}  // namespace
}  // namespace palpate::simd
