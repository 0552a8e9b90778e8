#include "field/simd/sums.inl"
// Needs the one above.
#include "field/simd/edges.inl"

namespace palpate::simd {

const Functions kBaseline{&weights_of, &all_of, &gradient, &bound_of, &edges_of};

}  // namespace palpate::simd
