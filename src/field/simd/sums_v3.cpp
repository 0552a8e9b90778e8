// Compiled with -march=x86-64-v3 on x86 (src/field/CMakeLists.txt).
#include "field/simd/sums.inl"
// Needs the one above.
#include "field/simd/edges.inl"

namespace palpate::simd {

const Functions kV3{&weights_of, &all_of, &gradient, &bound_of, &edges_of};

}  // namespace palpate::simd
