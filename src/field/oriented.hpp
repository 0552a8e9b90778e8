// Surfaces from normals. Notation as in docs/method.md: q_i = p_i - x, v_i = c_i w_i,
// V = sum v, A = sum v q / V, Nb = sum v n / V.
#pragma once

#include <Eigen/Core>

#include "field/simd/sums.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {

/// A function with its gradient.
struct Value {
  double f = 0;
  Eigen::Vector3d grad = Eigen::Vector3d::Zero();
};

[[nodiscard]] inline Eigen::Vector3d vector(const double v[3]) noexcept {
  return Eigen::Map<const Eigen::Vector3d>(v);
}

inline void assign(double to[3], const Eigen::Vector3d& from) noexcept {
  for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

/// A function of sums whose gradient is base + sum grad v_i b_i; what `simd::gradient` needs.
struct Oriented {
  double f = 0;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  ///< the part of the gradient outside the sum
  simd::Linear b{};
};

/// Half point-set surface, half IMLS: f = 1/2 [-Nb . A - sum v n.q / V].
[[nodiscard]] Oriented balanced(const simd::Moments& sums) noexcept;

/// Eqs. (5)-(7): f = n . (x - A), and its exact gradient.
[[nodiscard]] Oriented pointset(const simd::Moments& sums) noexcept;

/// a R = sum v n.q / V - Nb . A, the height of the point-set surface above IMLS: above 0 where the
/// surface is convex as the normals see it, 0 on a plane, below 0 where it is concave.
[[nodiscard]] Oriented convexity(const simd::Moments& sums) noexcept;

/// |Nb|^2: 1 where all normals agree, (1 + cos) / 2 between two equal sheets whose normals stand at
/// that angle, 0 where they oppose each other.
[[nodiscard]] Oriented normal_square(const simd::Moments& sums) noexcept;

/// to += factor * from.
void add(Oriented& to, double factor, const Oriented& from) noexcept;

/// Where a field is evaluated and what is known there already.
struct FieldPlace {
  const simd::Functions* functions = nullptr;
  const simd::Columns* columns = nullptr;
  Kernel kernel = Kernel::wyvill;
  const double* x = nullptr;        ///< relative to the patch, 3 entries, m
  const simd::Sums* all = nullptr;  ///< of `all` there
  int label = 0;                    ///< that is looked at here
  Value radius;                     ///< R(x), m

  [[nodiscard]] const simd::LabelSums& sums() const noexcept { return all->label[label]; }

  /// sum grad v_i b_i over the label's points.
  [[nodiscard]] Eigen::Vector3d gradient(const simd::Linear& b) const noexcept {
    Eigen::Vector3d sum;
    functions->gradient(*columns, columns->begin_of(label), columns->begin_of(label + 1), x, b,
                        sum.data());
    return sum;
  }
  /// The same over one source's.
  [[nodiscard]] Eigen::Vector3d gradient_of_source(int source,
                                                   const simd::Linear& b) const noexcept {
    Eigen::Vector3d sum;
    const std::uint32_t* const run = columns->run_begin + label * columns->sources + source;
    functions->gradient(*columns, run[0], run[1], x, b, sum.data());
    return sum;
  }
};

}  // namespace palpate
