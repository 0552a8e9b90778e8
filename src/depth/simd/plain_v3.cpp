// Compiled with -march=x86-64-v3 on x86 (src/depth/CMakeLists.txt).
#include "depth/simd/plain.inl"

namespace palpate::simd {

const PlainFunctions kPlainV3{&average, &reject, &fit};

}  // namespace palpate::simd
