// Compiled with -march=x86-64-v3 on x86 (src/geometry/CMakeLists.txt).
#include "geometry/simd/joins.inl"

namespace palpate::simd {

constexpr JoinFunctions kJoinsV3 = Joins<8>::functions();

}  // namespace palpate::simd
