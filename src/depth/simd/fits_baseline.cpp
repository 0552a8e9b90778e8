#include "depth/simd/fits.inl"
#include "depth/simd/table.inl"

namespace palpate::simd {

const FitFunctions kFitsBaseline{&build_table, &fit_blocks};

}  // namespace palpate::simd
