#include "depth/simd/plain.inl"

namespace palpate::simd {

const PlainFunctions kPlainBaseline{&average, &reject, &fit};

}  // namespace palpate::simd
