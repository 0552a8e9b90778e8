// The bodies behind `Functions`, included by one source file for each level of the instruction
// set. Everything stands in an anonymous namespace: code for a newer processor must never be
// merged into what an older one runs.

#include "field/simd/lanes.inl"

namespace palpate::simd {
namespace {

// w and -g up to the factors below (derived: docs/method.md 2.1), which multiply finished sums.
struct Weight {
  Lanes w;
  Lanes steep;
};
template <bool kWendland>
constexpr double kScaleW = kWendland ? 1 : 1. / 9;  // w = s^4 (4 r + 1) or s^2 (5 + 4 s) / 9
template <bool kWendland>
constexpr double kScaleSteep = kWendland ? 20 : 4. / 9;  // -g = 20 s^3 or 4 / 9 s (5 + 6 s)

// Eqs. (1) and (2) with their slopes (field/formulas.hpp), at q = r^2.
// Without the attribute it is called and not inlined, which costs more than it computes.
template <bool kWendland>
[[gnu::always_inline]] inline Weight kernel(const Lanes& q) {
  const Lanes r = kWendland ? root(q) : q;
  const Lanes s = positive(1.0 - r);
  if constexpr (kWendland) {
    const Lanes s3 = s * s * s;
    return {s * s3 * (4.0 * r + 1.0), s3};
  }
  const Lanes twice = s + s;
  const Lanes sum45 = 5.0 + (twice + twice);  // 5 + 4 s; a product less
  return {s * s * sum45, s * (sum45 + twice)};
}

// sum w and sum w R with their gradients. Where all radii are equal, the latter follow.
template <bool kUneven>
struct WeightSums {
  Lanes w{};
  Vector grad_w;
  Lanes wr{};
  Vector grad_wr;

  void add_point(const Columns& c, std::uint32_t i, const Vector& q, const Lanes& wi,
                 const Lanes& slope) {
    w += wi;
    add(grad_w, slope, q);
    if constexpr (kUneven) {
      const Lanes radius = load(c.radius + i);
      wr += wi * radius;
      add(grad_wr, slope * radius, q);
    }
  }

  void finish(const Columns& c, int source, double scale_w, double scale_grad, Sums& out) const {
    const double of_run = scale_w * sum(w);
    const double radius = kUneven ? scale_w * sum(wr) : c.uniform_radius * of_run;
    out.w[source] += of_run;
    out.wr_of[source] += radius;
    out.wr += radius;
    double grad[3];
    double by_radius[3];
    store(grad_w, scale_grad, grad);
    store(kUneven ? grad_wr : grad_w, scale_grad, by_radius);
    for (int axis = 0; axis < 3; ++axis) {
      if constexpr (!kUneven) by_radius[axis] *= c.uniform_radius;
      out.grad_w[source][axis] += grad[axis];
      out.grad_wr_of[source][axis] += by_radius[axis];
      out.grad_wr[axis] += by_radius[axis];
    }
  }
};

inline void clear(const Columns& c, Sums& out) {
  out.wr = 0;
  for (double& axis : out.grad_wr) axis = 0;
  for (int s = 0; s < c.sources; ++s) {
    out.w[s] = out.wr_of[s] = 0;
    for (int axis = 0; axis < 3; ++axis) out.grad_w[s][axis] = out.grad_wr_of[s][axis] = 0;
  }
}

template <bool kWendland, bool kUneven>
void weights(const Columns& c, const double x[3], Sums& out) noexcept {
  clear(c, out);
  for (int run = 0; run < c.labels * c.sources; ++run) {
    WeightSums<kUneven> sums;
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; i += kLanes) {
      const Vector q = offsets(c, i, x);
      const Lanes inverse_r2 = load(c.inverse_r2 + i);
      const Weight k = kernel<kWendland>(dot(q, q) * inverse_r2);
      const Lanes weight = load(c.weight + i);
      sums.add_point(c, i, q, weight * k.w, weight * k.steep * inverse_r2);
    }
    sums.finish(c, run % c.sources, kScaleW<kWendland>, kScaleSteep<kWendland>, out);
  }
}

// Terms that need normals, beside those of `weights`.
struct NormalSums {
  Lanes v{};
  Lanes vnq{};
  Vector grad_v;
  Vector vq;
  Vector vn;

  void add_point(const Columns& c, std::uint32_t i, const Vector& q, const Lanes& w,
                 const Lanes& slope) {
    const Lanes confidence = load(c.confidence + i);
    const Vector n = load3(c.normal, i);
    const Lanes vi = w * confidence;
    v += vi;
    vnq += vi * dot(n, q);
    add(grad_v, slope * confidence, q);
    add(vq, vi, q);
    add(vn, vi, n);
  }

  void finish(int source, LabelSums& out) const {
    SourceMoments& of = out.of[source];
    of.v = sum(v);
    of.vnq = sum(vnq);
    store(vn, 1, of.vn);
    out.v += of.v;
    out.vnq += of.vnq;
    double grad[3];
    double first[3];
    store(grad_v, 1, grad);
    store(vq, 1, first);
    for (int axis = 0; axis < 3; ++axis) {
      out.grad_v[axis] += grad[axis];
      out.vq[axis] += first[axis];
      out.vn[axis] += of.vn[axis];
    }
  }
};

inline void clear(LabelSums& out) {
  out.v = out.vnq = 0;
  for (int axis = 0; axis < 3; ++axis) out.grad_v[axis] = out.vq[axis] = out.vn[axis] = 0;
}

// Lists the groups of points that reach to x. The others would add zeros to all sums; in a patch
// that is much wider than a support they are most of it.
inline void find_near(const Columns& c, const double x[3], Sums& out) noexcept {
  std::uint32_t count = 0;
  for (int run = 0; run < c.labels * c.sources; ++run) {
    out.near_begin[run] = count;
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; i += kLanes) {
      const Vector q = offsets(c, i, x);
      c.near[count] = i;
      count += any(dot(q, q) * load(c.inverse_r2 + i) < 1.0) ? 1 : 0;
    }
  }
  out.near_begin[c.labels * c.sources] = count;
}

template <bool kWendland, bool kUneven>
void all(const Columns& c, const double x[3], Sums& out) noexcept {
  clear(c, out);
  find_near(c, x, out);
  for (int label = 0; label < c.labels; ++label) clear(out.label[label]);
  for (int run = 0; run < c.labels * c.sources; ++run) {
    WeightSums<kUneven> sums;
    NormalSums normals;
    for (std::uint32_t g = out.near_begin[run]; g < out.near_begin[run + 1]; ++g) {
      const std::uint32_t i = c.near[g];
      const Vector q = offsets(c, i, x);
      const Lanes inverse_r2 = load(c.inverse_r2 + i);
      const Weight k = kernel<kWendland>(dot(q, q) * inverse_r2);
      const Lanes weight = load(c.weight + i);
      const Lanes slope = kScaleSteep<kWendland> * (weight * k.steep * inverse_r2);
      std::memcpy(c.slope + i, &slope, sizeof slope);
      const Lanes w = kScaleW<kWendland> * (weight * k.w);
      sums.add_point(c, i, q, w, slope);
      normals.add_point(c, i, q, w, slope);
    }
    sums.finish(c, run % c.sources, 1, 1, out);
    normals.finish(run % c.sources, out.label[run / c.sources]);
  }
}

void gradient(const Columns& c, std::uint32_t begin, std::uint32_t end, const double x[3],
              const Linear& b, double out[3]) noexcept {
  const Vector alpha = same(b.alpha);
  const Vector beta = same(b.beta);
  Vector total;
  for (std::uint32_t k = begin; k < end; ++k) {
    const std::uint32_t i = c.near[k];
    const Vector q = offsets(c, i, x);
    const Vector n = load3(c.normal, i);
    const Lanes bi = dot(n, alpha) + dot(q, beta) + dot(n, q) * b.gamma + b.delta;
    add(total, load(c.slope + i) * load(c.confidence + i) * bi, q);
  }
  store(total, 1, out);
}

template <bool kWendland>
void bound(const Columns& c, const double x[3], double h, double out[kMaxSources]) noexcept {
  for (int s = 0; s < c.sources; ++s) out[s] = 0;
  for (int run = 0; run < c.labels * c.sources; ++run) {
    Lanes w{};
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; i += kLanes) {
      const Vector q = offsets(c, i, x);
      const Lanes nearest = positive(root(dot(q, q)) - h);
      const Lanes r2 = nearest * nearest * load(c.inverse_r2 + i);
      w += load(c.weight + i) * kernel<kWendland>(r2).w;
    }
    out[run % c.sources] += kScaleW<kWendland> * sum(w);
  }
}

void weights_of(const Columns& c, bool wendland, const double x[3], Sums& out) noexcept {
  const bool uneven = c.uniform_radius <= 0;
  if (wendland) {
    uneven ? weights<true, true>(c, x, out) : weights<true, false>(c, x, out);
  } else {
    uneven ? weights<false, true>(c, x, out) : weights<false, false>(c, x, out);
  }
}
void all_of(const Columns& c, bool wendland, const double x[3], Sums& out) noexcept {
  const bool uneven = c.uniform_radius <= 0;
  if (wendland) {
    uneven ? all<true, true>(c, x, out) : all<true, false>(c, x, out);
  } else {
    uneven ? all<false, true>(c, x, out) : all<false, false>(c, x, out);
  }
}
void bound_of(const Columns& c, bool wendland, const double x[3], double h,
              double out[kMaxSources]) noexcept {
  wendland ? bound<true>(c, x, h, out) : bound<false>(c, x, h, out);
}

}  // namespace
}  // namespace palpate::simd
