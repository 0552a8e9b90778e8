// Compiled with -march=x86-64-v3 on x86 (src/depth/CMakeLists.txt).
#include "depth/simd/fits.inl"
#include "depth/simd/table.inl"

namespace palpate::simd {

const FitFunctions kFitsV3{&build_table, &fit_blocks};

}  // namespace palpate::simd
