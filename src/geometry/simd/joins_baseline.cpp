#include "geometry/simd/joins.inl"

namespace palpate::simd {

constexpr JoinFunctions kJoinsBaseline = Joins<4>::functions();

}  // namespace palpate::simd
