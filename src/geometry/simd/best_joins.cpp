#include "base/cpu.hpp"
#include "geometry/simd/joins.hpp"

namespace palpate::simd {

const JoinFunctions& best_joins() noexcept {
  return cpu_has_v3() ? kJoinsV3 : kJoinsBaseline;
}

}  // namespace palpate::simd
