#include "field/simd/sums.inl"

namespace palpate::simd {

const Functions kBaseline{&weights_of, &all_of, &gradient, &bound_of, &edges_of};

}  // namespace palpate::simd
