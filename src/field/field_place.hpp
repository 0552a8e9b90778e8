#pragma once

#include "field/oriented.hpp"
#include "palpate/field/kernel.hpp"

namespace palpate {

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
