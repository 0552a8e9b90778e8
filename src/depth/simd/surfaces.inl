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

// Rays through the middles of windows, and blocks for one unit of the ray.
struct Rays {
  Doubles x, y;
  double per_x, per_y;
};

// What the quadratic fit lacks of a surface whose second fundamental form does not change (a
// sphere, a cylinder): its third derivatives follow from the first and second (docs/method.md 6.3).
[[gnu::always_inline]] inline Surface turn_at(const Fits& f, const Rays& rays, const Doubles& du,
                                              const Doubles& dv) {
  const Doubles& mu = f.shape.mu;
  const Doubles& mv = f.shape.mv;
  const Doubles rho = f.m - f.cuu * mu - f.cvv * mv;  // at the middle
  // How far the surface goes back along rays, times rho, and its metric, times rho^2.
  const Doubles wx = -f.cu * rays.per_x;
  const Doubles wy = -f.cv * rays.per_y;
  const Doubles square = 1.0 + rays.x * rays.x + rays.y * rays.y;
  const Doubles gxx = rho * (rho + 2.0 * wx * rays.x) + wx * wx * square;
  const Doubles gxy = rho * (wx * rays.y + wy * rays.x) + wx * wy * square;
  const Doubles gyy = rho * (rho + 2.0 * wy * rays.y) + wy * wy * square;
  const Doubles px = rho * rays.x + wx * square;
  const Doubles py = rho * rays.y + wy * square;
  const Doubles per_g = -1.0 / (gxx * gyy - gxy * gxy);
  const Doubles along_u = (gyy * px - gxy * py) * rays.per_x;
  const Doubles along_v = (gxx * py - gxy * px) * rays.per_y;
  Doubles tu = (2.0 * f.cuu * along_u + f.cuv * along_v) * per_g;
  Doubles tv = (f.cuv * along_u + 2.0 * f.cvv * along_v) * per_g;
  // Where the bend changes by more than half between the window's middle and its border, it is no
  // such surface, or further terms are large, too (judgement). 3 mu is the square of the reach.
  const Mask converges = 3.0 * (tu * tu * mu + tv * tv * mv) <= 0.25;
  tu = converges ? tu : Doubles{};
  tv = converges ? tv : Doubles{};
  const Doubles uuu = f.cuu * tu;
  const Doubles uuv = f.cuu * tv + f.cuv * tu;
  const Doubles uvv = f.cvv * tu + f.cuv * tv;
  const Doubles vvv = f.cvv * tv;
  // u^3 - ku u is orthogonal to u: ku is the mean of u^4 over that of u^2.
  const Doubles ku = 1.8 * mu - .2;
  const Doubles kv = 1.8 * mv - .2;
  const Doubles uu = du * du;
  const Doubles vv = dv * dv;
  return {(uuu * (uu - ku) + uvv * (vv - mv)) * du + (uuv * (uu - mu) + vvv * (vv - kv)) * dv,
          uuu * (3.0 * uu - ku) + 2.0 * uuv * du * dv + uvv * (vv - mv),
          uuv * (uu - mu) + 2.0 * uvv * du * dv + vvv * (3.0 * vv - kv),
          Doubles{},
          Doubles{},
          Doubles{}};
}

// The affine surface where `affine` is set, the bent one elsewhere.
[[gnu::always_inline]] inline Surface surface_at(const Fits& f, const Mask& affine,
                                                 const Rays& rays, const Doubles& du,
                                                 const Doubles& dv) {
  Surface s = affine_at(f, du, dv);
  if (!any(~affine)) return s;
  const Surface b = bend_at(f, du, dv);
  const Surface t = turn_at(f, rays, du, dv);
  const Doubles none{};
  s.rho += affine ? none : b.rho + t.rho;
  s.slope_u += affine ? none : b.slope_u + t.slope_u;
  s.slope_v += affine ? none : b.slope_v + t.slope_v;
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
