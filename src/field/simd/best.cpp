#include "base/cpu.hpp"
#include "field/simd/sums.hpp"

namespace palpate::simd {

const Functions& best() noexcept {
  return cpu_has_v3() ? kV3 : kBaseline;
}

}  // namespace palpate::simd
