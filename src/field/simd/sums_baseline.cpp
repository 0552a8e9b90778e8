#include "field/simd/sums.inl"
// Needs the one above.
#include "field/simd/robust.inl"

namespace palpate::simd {

const Functions kBaseline{&weights_of, &all_of, &gradient, &bound_of,
                          &near_of,    &share,  &robust,   &pull};

}  // namespace palpate::simd
