#include "base/cpu.hpp"
#include "depth/simd/fits.hpp"
#include "depth/simd/plain.hpp"

namespace palpate::simd {

const FitFunctions& best_fits() noexcept {
  return cpu_has_v3() ? kFitsV3 : kFitsBaseline;
}

const PlainFunctions& best_plain() noexcept {
  return cpu_has_v3() ? kPlainV3 : kPlainBaseline;
}

}  // namespace palpate::simd
