#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace palpate::test {

/// A number and its gradient with respect to the place x. The product rule does the rest, so
/// formulas carry no gradient of their own that could share a mistake with the fast ones.
struct Dual {
  double v = 0;
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
};
inline Dual constant(double v) {
  return {v, Eigen::Vector3d::Zero()};
}
inline Dual operator+(const Dual& a, const Dual& b) {
  return {a.v + b.v, a.g + b.g};
}
inline Dual operator-(const Dual& a, const Dual& b) {
  return {a.v - b.v, a.g - b.g};
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return {a.v * b.v, a.v * b.g + b.v * a.g};
}
inline Dual operator*(double a, const Dual& b) {
  return {a * b.v, a * b.g};
}
inline Dual operator/(const Dual& a, const Dual& b) {
  return {a.v / b.v, (a.g - (a.v / b.v) * b.g) / b.v};
}
inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.v);
  return {root, a.g / (2 * root)};
}
using DualVector = std::array<Dual, 3>;
inline Dual dot(const DualVector& a, const DualVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline DualVector operator/(const DualVector& a, const Dual& b) {
  return {a[0] / b, a[1] / b, a[2] / b};
}
inline Dual abs(const Dual& a) {
  return a.v < 0 ? -1.0 * a : a;
}

}  // namespace palpate::test
