// The bodies behind `Functions`, included by one source file for each level of the instruction
// set. Everything stands in an anonymous namespace: code for a newer processor must never be
// merged into what an older one runs.

#include <experimental/simd>

#include "field/simd/sums.hpp"

namespace palpate::simd {
namespace {

namespace stdx = std::experimental;
using Lanes = stdx::fixed_size_simd<double, kLanes>;

inline Lanes load(const double* p) {
  return Lanes(p, stdx::element_aligned);
}

// In a fixed order, so that every level gives the same bits.
inline double sum(const Lanes& v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

struct Vector {
  Lanes x = 0;
  Lanes y = 0;
  Lanes z = 0;
};
inline Lanes dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline void add(Vector& to, const Lanes& w, const Vector& v) {
  to.x += w * v.x;
  to.y += w * v.y;
  to.z += w * v.z;
}
inline void store(const Vector& v, double out[3]) {
  out[0] = sum(v.x);
  out[1] = sum(v.y);
  out[2] = sum(v.z);
}
inline Vector load3(const double* const column[3], std::uint32_t i) {
  return {load(column[0] + i), load(column[1] + i), load(column[2] + i)};
}
inline Vector offsets(const Columns& c, std::uint32_t i, const double x[3]) {
  const Vector p = load3(c.position, i);
  return {p.x - x[0], p.y - x[1], p.z - x[2]};
}

struct Weight {
  Lanes w;
  Lanes g;
};

// Eqs. (1) and (2) with their slopes (field/kernel.hpp), at q = r^2.
template <bool kWendland>
inline Weight kernel(Lanes q) {
  Weight k;
  if constexpr (kWendland) {
    const Lanes r = stdx::sqrt(q);
    const Lanes s = 1.0 - r;
    k.g = -20.0 * (s * s * s);
    k.w = s * s * s * s * (4.0 * r + 1.0);
  } else {
    k.w = 1.0 + q * (-22. / 9 + q * (17. / 9 - q * (4. / 9)));
    k.g = 2.0 * (-22. / 9 + q * (34. / 9 - q * (12. / 9)));
  }
  stdx::where(q >= 1.0, k.w) = 0.0;
  stdx::where(q >= 1.0, k.g) = 0.0;
  return k;
}

template <bool kWendland>
void weights(const Columns& c, const double x[3], Sums& out) noexcept {
  Lanes wr = 0;
  Vector grad_wr;
  for (int s = 0; s < c.sources; ++s) {
    Lanes w = 0;
    Vector grad_w;
    for (std::uint32_t i = c.source_begin[s]; i < c.source_begin[s + 1]; i += kLanes) {
      const Vector q = offsets(c, i, x);
      const Lanes inverse_r2 = load(c.inverse_r2 + i);
      const Weight k = kernel<kWendland>(dot(q, q) * inverse_r2);
      const Lanes weight = load(c.weight + i);
      const Lanes radius = load(c.radius + i);
      const Lanes slope = -(weight * k.g * inverse_r2);
      w += weight * k.w;
      wr += weight * k.w * radius;
      add(grad_w, slope, q);
      add(grad_wr, slope * radius, q);
    }
    out.w[s] = sum(w);
    store(grad_w, out.grad_w[s]);
  }
  out.wr = sum(wr);
  store(grad_wr, out.grad_wr);
}

// Terms that need normals, beside those of `weights`.
struct NormalSums {
  Lanes v = 0;
  Lanes vnq = 0;
  Vector grad_v;
  Vector vq;
  Vector vn;

  void add_point(const Columns& c, std::uint32_t i, const Vector& q, Lanes w, Lanes slope) {
    const Lanes confidence = load(c.confidence + i);
    const Vector n = load3(c.normal, i);
    const Lanes vi = w * confidence;
    v += vi;
    vnq += vi * dot(n, q);
    add(grad_v, slope * confidence, q);
    add(vq, vi, q);
    add(vn, vi, n);
  }
};

template <bool kWendland>
void all(const Columns& c, const double x[3], Sums& out) noexcept {
  NormalSums normals;
  Lanes wr = 0;
  Vector grad_wr;
  for (int s = 0; s < c.sources; ++s) {
    Lanes w = 0;
    Vector grad_w;
    for (std::uint32_t i = c.source_begin[s]; i < c.source_begin[s + 1]; i += kLanes) {
      const Vector q = offsets(c, i, x);
      const Lanes inverse_r2 = load(c.inverse_r2 + i);
      const Weight k = kernel<kWendland>(dot(q, q) * inverse_r2);
      const Lanes weight = load(c.weight + i);
      const Lanes radius = load(c.radius + i);
      const Lanes slope = -(weight * k.g * inverse_r2);
      const Lanes wi = weight * k.w;
      slope.copy_to(c.slope + i, stdx::element_aligned);
      w += wi;
      wr += wi * radius;
      add(grad_w, slope, q);
      add(grad_wr, slope * radius, q);
      normals.add_point(c, i, q, wi, slope);
    }
    out.w[s] = sum(w);
    store(grad_w, out.grad_w[s]);
  }
  out.wr = sum(wr);
  store(grad_wr, out.grad_wr);
  out.v = sum(normals.v);
  out.vnq = sum(normals.vnq);
  store(normals.grad_v, out.grad_v);
  store(normals.vq, out.vq);
  store(normals.vn, out.vn);
}

void gradient(const Columns& c, const double x[3], const Linear& b, double out[3]) noexcept {
  const Vector alpha{b.alpha[0], b.alpha[1], b.alpha[2]};
  const Vector beta{b.beta[0], b.beta[1], b.beta[2]};
  Vector total;
  for (std::uint32_t i = 0; i < c.source_begin[c.sources]; i += kLanes) {
    const Vector q = offsets(c, i, x);
    const Vector n = load3(c.normal, i);
    const Lanes bi = dot(n, alpha) + dot(q, beta) + dot(n, q) * b.gamma + b.delta;
    add(total, load(c.slope + i) * load(c.confidence + i) * bi, q);
  }
  store(total, out);
}

template <bool kWendland>
void bound(const Columns& c, const double x[3], double h, double out[kMaxSources]) noexcept {
  for (int s = 0; s < c.sources; ++s) {
    Lanes w = 0;
    for (std::uint32_t i = c.source_begin[s]; i < c.source_begin[s + 1]; i += kLanes) {
      const Vector q = offsets(c, i, x);
      Lanes nearest = stdx::sqrt(dot(q, q)) - h;
      stdx::where(nearest < 0.0, nearest) = 0.0;
      const Lanes r2 = nearest * nearest * load(c.inverse_r2 + i);
      w += load(c.weight + i) * kernel<kWendland>(r2).w;
    }
    out[s] = sum(w);
  }
}

void weights_of(const Columns& c, bool wendland, const double x[3], Sums& out) noexcept {
  wendland ? weights<true>(c, x, out) : weights<false>(c, x, out);
}
void all_of(const Columns& c, bool wendland, const double x[3], Sums& out) noexcept {
  wendland ? all<true>(c, x, out) : all<false>(c, x, out);
}
void bound_of(const Columns& c, bool wendland, const double x[3], double h,
              double out[kMaxSources]) noexcept {
  wendland ? bound<true>(c, x, h, out) : bound<false>(c, x, h, out);
}

}  // namespace
}  // namespace palpate::simd
