#pragma once

#include "field/oriented.hpp"
#include "palpate/field/kernel.hpp"

namespace palpate {

/// Where a field is evaluated and what is known there already.
struct FieldPlace {
  const simd::Functions* functions = nullptr;
  const simd::Columns* columns = nullptr;
  Kernel kernel = Kernel::wyvill;
  const double* x = nullptr;         ///< relative to the patch, 3 entries, m
  const simd::Sums* sums = nullptr;  ///< of `all` there
  double sign = 1;                   ///< -1: seen from the side that normals point away from
  Value radius;                      ///< R(x), m
};

}  // namespace palpate
