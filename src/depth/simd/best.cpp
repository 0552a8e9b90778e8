#include "base/cpu.hpp"
#include "depth/simd/fits.hpp"

namespace palpate::simd {

const FitFunctions& best_fits() noexcept {
  return cpu_has_v3() ? kFitsV3 : kFitsBaseline;
}

}  // namespace palpate::simd
