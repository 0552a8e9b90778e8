#pragma once

// Windows of blocks and the surfaces fitted to them, four windows side by side. Everything stands
// in an anonymous namespace: code for a newer processor must never stand in for an older one's.

#include <cstring>

#include "depth/simd/fits.hpp"

namespace palpate::simd {
namespace {

constexpr int kLanes = 4;
typedef double Doubles __attribute__((vector_size(kLanes * sizeof(double))));
typedef long long Mask __attribute__((vector_size(kLanes * sizeof(double))));

// Counts and weights share a sum: each block that is not a hole adds kBlock, and 12 / pixels if it
// was measured.
constexpr double kBlock = 1 << 20;

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

// What a window's extent along one axis means: n = 2 half + 1 blocks with mean square mu =
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

// Four windows: middle (in blocks of the table) and half sizes.
struct Windows {
  int column[kLanes];
  int row[kLanes];
  int half_u[kLanes];
  int half_v[kLanes];
};

// Fits over full windows, in units of kRhoUnits and blocks from the middle: 1, u, v, u v, u^2 - mu,
// v^2 - mv are orthogonal there.
struct Fits {
  Doubles m, cu, cv, cuv, cuu, cvv;
  Doubles variance;          // of one block's inverse depth
  Doubles per_n, per_mu, per_mv, per_ku, per_kv, mu, mv;
  Mask full;                 // no hole, all inside the table
  Mask affine;               // the noise explains what the affine fit leaves
  Mask quadratic;            // or the quadratic one
};

struct Moments {
  Four low, high;
};

[[gnu::always_inline]] inline Moments moments(const WindowTable& table, const Windows& w,
                                              Mask& inside) {
  const std::ptrdiff_t stride = table.columns + 1;
  Doubles low[kLanes];
  Doubles high[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    std::ptrdiff_t left = w.column[l] - w.half_u[l];
    std::ptrdiff_t right = w.column[l] + w.half_u[l] + 1;
    std::ptrdiff_t top = w.row[l] - w.half_v[l];
    std::ptrdiff_t bottom = w.row[l] + w.half_v[l] + 1;
    const bool is = left >= 0 && top >= 0 && right <= table.columns && bottom <= table.rows;
    inside[l] = is ? -1 : 0;
    if (!is) left = right = top = bottom = 0;
    const double* top_left = table.sums + kWindowSums * (top * stride + left);
    const double* top_right = table.sums + kWindowSums * (top * stride + right);
    const double* bottom_left = table.sums + kWindowSums * (bottom * stride + left);
    const double* bottom_right = table.sums + kWindowSums * (bottom * stride + right);
    low[l] = (load(bottom_right) - load(bottom_left)) - (load(top_right) - load(top_left));
    high[l] = (load(bottom_right + 4) - load(bottom_left + 4)) -
              (load(top_right + 4) - load(top_left + 4));
  }
  return {transpose(low[0], low[1], low[2], low[3]), transpose(high[0], high[1], high[2], high[3])};
}

[[gnu::always_inline]] inline Four extents(const int half[kLanes]) {
  const auto row = [&](int l) { return load(&kExtents.of[half[l]].per_n); };
  return transpose(row(0), row(1), row(2), row(3));
}

// Is chi^2 = left / variance one that `degrees` of freedom may have: within three deviations?
[[gnu::always_inline]] inline Mask explained(const Doubles& left, const Doubles& variance, const Doubles& degrees) {
  const Doubles excess = left - degrees * variance;
  return (excess <= 0.0) | (excess * excess <= 18.0 * degrees * variance * variance);
}

[[gnu::always_inline]] inline Doubles noise_sigma(const double noise[3], const Doubles& rho) {
  return kRhoUnits * noise[2] + rho * (noise[1] + rho * (noise[0] / kRhoUnits));
}

[[gnu::always_inline]] inline Fits fit(const FitInput& input, const Windows& w) {
  const WindowTable& table = input.table;
  Fits f;
  Moments s;
  Doubles u;
  Doubles v;
  Doubles area;
  s = moments(table, w, f.full);
  for (int l = 0; l < kLanes; ++l) {
    u[l] = w.column[l] - table.columns / 2;
    v[l] = w.row[l] - table.rows / 2;
    area[l] = (2 * w.half_u[l] + 1) * (2 * w.half_v[l] + 1);
  }
  const auto& [r, su, sv, suu] = s.low.v;
  const auto& [suv, svv, srr, counts] = s.high.v;
  const Four eu = extents(w.half_u);
  const Four ev = extents(w.half_v);
  f.per_n = eu.v[0] * ev.v[0];
  f.per_mu = eu.v[1];
  f.per_ku = eu.v[2];
  f.mu = eu.v[3];
  f.per_mv = ev.v[1];
  f.per_kv = ev.v[2];
  f.mv = ev.v[3];
  const Doubles bu = su - u * r;
  const Doubles bv = sv - v * r;
  const Doubles buv = suv - u * sv - v * bu;
  const Doubles buu = suu - u * (su + bu) - f.mu * r;
  const Doubles bvv = svv - v * (sv + bv) - f.mv * r;
  f.m = r * f.per_n;
  f.cu = bu * (f.per_n * f.per_mu);
  f.cv = bv * (f.per_n * f.per_mv);
  f.cuv = buv * (f.per_n * f.per_mu * f.per_mv);
  f.cuu = buu * (f.per_n * f.per_ku);
  f.cvv = bvv * (f.per_n * f.per_kv);
  const Doubles weights = counts - kBlock * area;
  f.full &= weights >= 0.0;
  const Doubles sigma = noise_sigma(input.noise, f.m);
  // The rounding to whole units is noise too.
  f.variance = larger(sigma * sigma * (weights * f.per_n * (1. / 3)), same(1. / 12));
  const Doubles left = srr - r * f.m - f.cu * bu - f.cv * bv;
  const Doubles bent = f.cuv * buv + f.cuu * buu + f.cvv * bvv;
  f.affine = f.full & explained(left, f.variance, area - 3.0) & (bent <= 12.0 * f.variance);
  f.quadratic = f.full & explained(left - bent, f.variance, area - 6.0);
  return f;
}

// The surface of a fit at (du, dv) blocks from the middle.
struct Surface {
  Doubles rho, slope_u, slope_v;  // per block
  Doubles var_rho, var_u, var_v;
};

[[gnu::always_inline]] inline Surface affine_at(const Fits& f, const Doubles& du, const Doubles& dv) {
  const Doubles var = f.variance * f.per_n;
  return {f.m + f.cu * du + f.cv * dv,
          f.cu,
          f.cv,
          var * (1.0 + du * du * f.per_mu + dv * dv * f.per_mv),
          var * f.per_mu,
          var * f.per_mv};
}

// What the quadratic terms add to it.
[[gnu::always_inline]] inline Surface bend_at(const Fits& f, const Doubles& du, const Doubles& dv) {
  const Doubles var = f.variance * f.per_n;
  const Doubles uu = du * du - f.mu;
  const Doubles vv = dv * dv - f.mv;
  const Doubles per_uv = f.per_mu * f.per_mv;
  return {f.cuv * du * dv + f.cuu * uu + f.cvv * vv,
          f.cuv * dv + 2.0 * f.cuu * du,
          f.cuv * du + 2.0 * f.cvv * dv,
          var * (du * du * dv * dv * per_uv + uu * uu * f.per_ku + vv * vv * f.per_kv),
          var * (dv * dv * per_uv + 4.0 * du * du * f.per_ku),
          var * (du * du * per_uv + 4.0 * dv * dv * f.per_kv)};
}

// The affine surface where `affine` is set, the quadratic one elsewhere.
[[gnu::always_inline]] inline Surface surface_at(const Fits& f, const Mask& affine, const Doubles& du, const Doubles& dv) {
  const Surface a = affine_at(f, du, dv);
  const Surface b = bend_at(f, du, dv);
  const Doubles none{};
  return {a.rho + (affine ? none : b.rho),         a.slope_u + (affine ? none : b.slope_u),
          a.slope_v + (affine ? none : b.slope_v), a.var_rho + (affine ? none : b.var_rho),
          a.var_u + (affine ? none : b.var_u),     a.var_v + (affine ? none : b.var_v)};
}

// Expected squared error, slopes at a lever of L blocks: variance, and for an affine fit the square
// of what the quadratic one would change beyond its own variance.
[[gnu::always_inline]] inline Doubles score(const Fits& f, const Mask& affine, const Doubles& du, const Doubles& dv,
                     const Doubles& lever_u2, const Doubles& lever_v2) {
  const Surface a = affine_at(f, du, dv);
  const Surface b = bend_at(f, du, dv);
  const auto term = [&](const Doubles& variance, const Doubles& change, const Doubles& more) {
    return variance + (affine ? larger(change * change - more, same(0)) : more);
  };
  return term(a.var_rho, b.rho, b.var_rho) + lever_u2 * term(a.var_u, b.slope_u, b.var_u) +
         lever_v2 * term(a.var_v, b.slope_v, b.var_v);
}

}  // namespace
}  // namespace palpate::simd
