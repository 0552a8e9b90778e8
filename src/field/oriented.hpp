#pragma once

#include <Eigen/Core>
#include <optional>

#include "field/simd/sums.hpp"
#include "palpate/field/field_options.hpp"

// Surfaces from normals. Notation as in docs/method.md: q_i = p_i - x, v_i = c_i w_i,
// V = sum v, A = sum v q / V, Nb = sum v n / V.

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

/// sum v n.q / V - Nb . A, which is -h R of docs/method.md 2.6, the height of the point-set surface
/// above IMLS: above 0 where the surface is convex as the normals see it, 0 on a plane, below 0
/// where it is concave.
[[nodiscard]] Oriented convexity(const simd::Moments& sums) noexcept;

/// |Nb|^2: 1 where all normals agree, (1 + cos) / 2 between two equal surfaces whose normals stand
/// at that angle, 0 where they oppose each other.
[[nodiscard]] Oriented normal_square(const simd::Moments& sums) noexcept;

/// to += factor * from.
void add(Oriented& to, double factor, const Oriented& from) noexcept;

/// A position at which a field is evaluated, with the sums and the radius there.
struct FieldQuery {
  const simd::Functions* functions = nullptr;
  const simd::Columns* columns = nullptr;
  Kernel kernel = Kernel::wyvill;
  const double* x = nullptr;        ///< relative to the patch, 3 entries, m
  const simd::Sums* all = nullptr;  ///< what Functions::all gives there
  int label = 0;                    ///< that is looked at here
  Value radius;                     ///< R(x), m

  [[nodiscard]] const simd::LabelSums& sums() const noexcept { return all->label[label]; }

  /// Where the groups of a label's points begin that reach here.
  [[nodiscard]] std::uint32_t near_of(int of_label) const noexcept {
    return all->near_begin[of_label * columns->sources];
  }

  /// sum grad v_i b_i over the label's points.
  [[nodiscard]] Eigen::Vector3d gradient(const simd::Linear& b) const noexcept {
    Eigen::Vector3d sum;
    functions->gradient(*columns, near_of(label), near_of(label + 1), x, b, sum.data());
    return sum;
  }
  /// The same over one source's.
  [[nodiscard]] Eigen::Vector3d gradient_of_source(int source,
                                                   const simd::Linear& b) const noexcept {
    Eigen::Vector3d sum;
    const std::uint32_t* const run = all->near_begin + label * columns->sources + source;
    functions->gradient(*columns, run[0], run[1], x, b, sum.data());
    return sum;
  }
};

/// The correction of the height over all points where sources see one surface at different heights,
/// m, with its gradient. 0 for a single source, and where the sources agree.
///
/// Summed up together, points count by how near they are. Where two sources' surfaces lie more than
/// 0.7 R apart, the height is that of the one here and of the other there: two surfaces with a gap,
/// between which a proxy falls. Here each source has a height f_s = -sum v n.q / V_s of its own,
/// which counts by how much of the source's surface there is, whatever its height, and how finely
/// the source sees it:
///
///   c_s = V_s / (sqrt(T(|f_s| / R)^2 + 0.1^2) R_s^4),  lambda_s = c_s / sum c,
///   shift = tau (sum lambda_s f_s - sum V_s f_s / V)
///
/// T is what the weights of a plane at that height sum to, and 0.1 its floor. R_s, the source's
/// mean radius, grows as its rays graze, so that a source has faded before its surface ends at a
/// silhouette. tau, taken from |sum lambda_s n_s|, is 1 where normals of two sources differ by less
/// than 11 degrees and 0 from 23 on: the faces of an edge or of a thin plate do not disagree.
[[nodiscard]] Value united_shift(const FieldQuery& query) noexcept;

/// A surface of the label's points with its edges sharp: where points lie beside an edge, the mean
/// of the heights above what both planes leave replaces `smooth`. With its exact
/// gradient.
[[nodiscard]] Value with_edges(const FieldQuery& query, const Value& smooth) noexcept;

/// The length that closes acute creases: it is subtracted from the height as seen from the proxy's
/// side, m, with its gradient. 0 on single surfaces, between surfaces that meet at 114 degrees and
/// more, and wherever the surface is not concave.
///
/// Where two surfaces face each other within a support, their normals and heights cancel: the mean
/// of both stays near 0, or is free, far behind either of them, and a proxy slips through. With the
/// mean normal N and the concavity h = (N . A - sum v n.q / V) / R, signed by the side,
///
///   closure = 0.2 R S(1 - |N|^2 / 0.7) S(100 h),  S(u) = u^2 (3 - 2u), u within 0 and 1
///
/// |N|^2 is 1/2 between two equal surfaces at 90 degrees and 0 between parallel ones; the gate
/// opens before that, as surfaces are seldom equal. h is half the gap, over R, between surfaces
/// that face each other, and below 0 in the plate between surfaces that face away, which keeps its
/// shape.
[[nodiscard]] Value crease_closure(const FieldQuery& query) noexcept;

/// Smooth maximum of two lengths over a width k, of R, that may vary: C1 (docs/method.md 1).
[[nodiscard]] Value smooth_max(const Value& a, const Value& b, const Value& radius,
                               double width) noexcept;

/// The height above the surfaces at a position as they meet there: concave neighbours bound free
/// space with near faces, and far faces bound the solid with both (Facing). Nothing where no label
/// has more than `least` of trusted weight. With its exact gradient.
[[nodiscard]] std::optional<Value> joined_height(const FieldOptions& options, FieldQuery query,
                                                 double least) noexcept;

}  // namespace palpate
