#pragma once

// The surfaces of fits, four side by side, and what they are worth. In an anonymous namespace: see
// windows.inl.

#include "depth/simd/windows.inl"

namespace palpate::simd {
namespace {

// The surface of a fit at (du, dv) blocks from the middle.
struct Surface {
  Doubles rho, slope_u, slope_v;  // per block
  Doubles var_rho, var_u, var_v;
};

[[gnu::always_inline]] inline Surface affine_at(const Fits& f, const Doubles& du,
                                                const Doubles& dv) {
  const Doubles& per_n = f.shape.per_n;
  const Doubles mean = f.variance * per_n * shared_over(f.shared, 0, per_n);
  const Doubles var = f.variance * per_n * shared_over(f.shared, 1, per_n);
  return {f.m + f.cu * du + f.cv * dv,
          f.cu,
          f.cv,
          mean + var * (du * du * f.shape.per_mu + dv * dv * f.shape.per_mv),
          var * f.shape.per_mu,
          var * f.shape.per_mv};
}

// The part of the surface that the quadratic terms add.
[[gnu::always_inline]] inline Surface bend_at(const Fits& f, const Doubles& du, const Doubles& dv) {
  const Doubles& per_n = f.shape.per_n;
  const Doubles var = f.variance * per_n * shared_over(f.shared, 2, per_n);
  const Doubles uu = du * du - f.shape.mu;
  const Doubles vv = dv * dv - f.shape.mv;
  const Doubles per_uv = f.shape.per_mu * f.shape.per_mv;
  return {f.cuv * du * dv + f.cuu * uu + f.cvv * vv,
          f.cuv * dv + 2.0 * f.cuu * du,
          f.cuv * du + 2.0 * f.cvv * dv,
          var * (du * du * dv * dv * per_uv + uu * uu * f.shape.per_ku + vv * vv * f.shape.per_kv),
          var * (dv * dv * per_uv + 4.0 * du * du * f.shape.per_ku),
          var * (du * du * per_uv + 4.0 * dv * dv * f.shape.per_kv)};
}

// The affine surface where `affine` is set, the bent one elsewhere.
[[gnu::always_inline]] inline Surface surface_at(const Fits& f, const Mask& affine,
                                                 const Doubles& du, const Doubles& dv) {
  Surface s = affine_at(f, du, dv);
  if (!any(~affine)) return s;
  const Surface b = bend_at(f, du, dv);
  const Doubles none{};
  s.rho += affine ? none : b.rho;
  s.slope_u += affine ? none : b.slope_u;
  s.slope_v += affine ? none : b.slope_v;
  s.var_rho += affine ? none : b.var_rho;
  s.var_u += affine ? none : b.var_u;
  s.var_v += affine ? none : b.var_v;
  return s;
}

// Expected squared error, slopes at a lever of L blocks: variance, and for an affine fit the square
// of what the quadratic one would change beyond its own variance.
[[gnu::always_inline]] inline Doubles score(const Fits& f, const Mask& affine, const Doubles& du,
                                            const Doubles& dv, const Doubles& lever_u2,
                                            const Doubles& lever_v2) {
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
