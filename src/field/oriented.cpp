// Values and gradients of surfaces from normals; notation in oriented.hpp, derivation in method.md.
#include "field/oriented.hpp"

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

}  // namespace palpate
