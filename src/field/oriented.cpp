// Heights above surfaces made from normals, for one source and for several
// (docs/method.md 2.4, 2.9).

#include "field/oriented.hpp"

#include <array>
#include <cmath>
#include <span>

#include "field/formulas.hpp"

namespace palpate {

using Eigen::Vector3d;

Oriented balanced(const simd::Moments& sums) noexcept {
  const double s = 1 / sums.v;
  const Vector3d a = s * vector(sums.vq);
  const Vector3d nb = s * vector(sums.vn);
  const double imls = -s * sums.vnq;
  Oriented result;
  result.f = 0.5 * (imls - nb.dot(a));
  result.base = nb;
  assign(result.b.alpha, -0.5 * s * a);
  assign(result.b.beta, -0.5 * s * nb);
  result.b.gamma = -0.5 * s;
  result.b.delta = 0.5 * s * (2 * nb.dot(a) - imls);
  return result;
}

Oriented pointset(const simd::Moments& sums) noexcept {
  const double s = 1 / sums.v;
  const Vector3d a = s * vector(sums.vq);
  const double length = vector(sums.vn).norm();
  const Vector3d n = vector(sums.vn) / length;
  Oriented result;
  result.f = -n.dot(a);
  result.base = n;
  assign(result.b.alpha, -(a + n * result.f) / length);
  assign(result.b.beta, -s * n);
  result.b.gamma = 0;
  result.b.delta = s * n.dot(a);
  return result;
}

Oriented convexity(const simd::Moments& sums) noexcept {
  const double s = 1 / sums.v;
  const Vector3d a = s * vector(sums.vq);
  const Vector3d nb = s * vector(sums.vn);
  const double imls = -s * sums.vnq;
  Oriented result;
  result.f = -imls - nb.dot(a);
  assign(result.b.alpha, -s * a);
  assign(result.b.beta, -s * nb);
  result.b.gamma = s;
  result.b.delta = s * (imls + 2 * nb.dot(a));
  return result;
}

Oriented normal_square(const simd::Moments& sums) noexcept {
  const double s = 1 / sums.v;
  const Vector3d nb = s * vector(sums.vn);
  Oriented result;
  result.f = nb.squaredNorm();
  assign(result.b.alpha, 2 * s * nb);
  result.b.delta = -2 * s * result.f;
  return result;
}

void add(Oriented& to, double factor, const Oriented& from) noexcept {
  to.f += factor * from.f;
  to.base += factor * from.base;
  for (int axis = 0; axis < 3; ++axis) {
    to.b.alpha[axis] += factor * from.b.alpha[axis];
    to.b.beta[axis] += factor * from.b.beta[axis];
  }
  to.b.gamma += factor * from.b.gamma;
  to.b.delta += factor * from.b.delta;
}

namespace {

using Eigen::Vector3d;

constexpr double kFaint = 1e-9;  // share of all weight: a source with less is not there; judgement
constexpr double kFloor = 0.1;   // of T, which divides and must not vanish; judgement
constexpr double kFine = 4;      // power of 1 / R_s in c_s; judgement (docs/method.md 2.9)
// |sum lambda n| where heights begin to unite and where they do so fully: the cosines of 23 / 2 and
// 11 / 2 degrees, half the angle between two sources' normals. The angles are judgement.
constexpr double kUniteFrom = 0.98;
constexpr double kUniteFull = 0.995;  // docs/method.md 2.9

/// The height of one source and how much it counts.
struct Own {
  int source = 0;
  double v = 0;
  double height = 0;      ///< f_s, m
  Vector3d slope;         ///< sum v n / v
  Vector3d normal;        ///< of unit length
  double radius = 0;      ///< R_s, m
  Vector3d radius_slope;  ///< its gradient
  double cover = 0;       ///< c_s
  double steep = 0;       ///< d log c_s / d f_s, 1/m
  double share = 0;       ///< lambda_s
};

using Owns = std::array<Own, simd::kMaxSources>;

Own own(const FieldQuery& query, int source) noexcept {
  const simd::SourceMoments& of = query.sums().of[source];
  Own o;
  o.source = source;
  o.v = of.v;
  o.height = -of.vnq / of.v;
  o.slope = vector(of.vn) / of.v;
  o.normal = o.slope.normalized();
  const double radius = query.radius.f;
  const double eta = std::abs(o.height) / radius;
  const double phi = plane_threshold(query.kernel, eta);
  const double squared = phi * phi + kFloor * kFloor;
  const double w = query.all->w[source];
  o.radius = query.all->wr_of[source] / w;
  o.radius_slope =
      (vector(query.all->grad_wr_of[source]) - o.radius * vector(query.all->grad_w[source])) / w;
  const double r2 = o.radius * o.radius;
  o.cover = of.v / (std::sqrt(squared) * r2 * r2);
  if (eta < 1) {
    const double by_eta = -phi * plane_threshold_slope(query.kernel, eta) / squared;
    o.steep = std::copysign(by_eta / radius, o.height);
  }
  return o;
}

/// Lists the sources that are there, with their shares. Returns how many; 0 when one has no normal
/// here.
int list(const FieldQuery& query, Owns& owns) noexcept {
  int count = 0;
  double covers = 0;
  for (int s = 0; s < query.columns->sources; ++s) {
    const simd::SourceMoments& of = query.sums().of[s];
    if (!(of.v > kFaint * query.sums().v)) continue;
    if (!(vector(of.vn).norm() > kFaint * of.v)) return 0;
    owns[static_cast<std::size_t>(count)] = own(query, s);
    covers += owns[static_cast<std::size_t>(count++)].cover;
  }
  for (Own& o : std::span(owns).first(static_cast<std::size_t>(count))) o.share = o.cover / covers;
  return count;
}

}  // namespace

Value united_shift(const FieldQuery& query) noexcept {
  Owns all;
  const int count = query.columns->sources > 1 ? list(query, all) : 0;
  if (count < 2) return {};
  const auto owns = std::span(all).first(static_cast<std::size_t>(count));
  const double v = query.sums().v;
  double by_cover = 0;
  double by_weight = 0;
  Vector3d normal = Vector3d::Zero();
  for (const Own& o : owns) {
    by_cover += o.share * o.height;
    by_weight += o.v / v * o.height;
    normal += o.share * o.normal;
  }
  const double coherence = normal.norm();
  const SmoothStep tau = smooth_step(coherence, kUniteFrom, kUniteFull - kUniteFrom);
  if (tau.value <= 0) return {};
  normal /= coherence;
  const double offset = by_cover - by_weight;
  // Chain rule through f_s, V_s, the normals and R.
  Value result{tau.value * offset, Vector3d::Zero()};
  double by_radius = 0;
  for (const Own& o : owns) {
    const double aligned = normal.dot(o.normal);
    const double by_log =
        o.share * (tau.value * (o.height - by_cover) + tau.slope * offset * (aligned - coherence));
    const double by_height = tau.value * (o.share - o.v / v) + by_log * o.steep;
    const double by_v = by_log / o.v - tau.value * (o.height - by_weight) / v;
    by_radius -= by_log * o.steep * o.height / query.radius.f;
    simd::Linear b{};
    assign(b.alpha,
           tau.slope * offset * o.share / (o.v * o.slope.norm()) * (normal - aligned * o.normal));
    b.gamma = -by_height / o.v;
    b.delta = -by_height * o.height / o.v + by_v;
    const Vector3d sum = query.gradient_of_source(o.source, b);
    result.grad += by_height * o.slope + sum - by_log * kFine / o.radius * o.radius_slope;
  }
  result.grad += by_radius * query.radius.grad;
  return result;
}

}  // namespace palpate
