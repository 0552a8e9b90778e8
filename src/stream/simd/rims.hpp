#pragma once

// The sums over what is around blocks beside rims, compiled once for each level of the instruction
// set.

#include <cstddef>
#include <cstdint>

namespace palpate::simd {

constexpr int kRimLanes = 8;  // blocks side by side

// Columns of blocks: pointers are to the first of eight.
struct Surroundings {
  const float* x;  // m
  const float* y;
  const float* z;
  const float* per_r2;  // 1 / R^2, 1/m^2
  const float* factors;
  std::ptrdiff_t stride;  // from row to row
};

struct RimFunctions {
  // Sums weights times `factors` over windows around eight blocks, that reach `halves` blocks to
  // either side.
  void (*around)(const Surroundings& blocks, bool wendland, const std::int32_t* halves,
                 float* sums) noexcept;
};

extern const RimFunctions kRimsBaseline;
extern const RimFunctions kRimsV3;  // x86-64-v3; the same numbers bit for bit

// The better that this processor has.
const RimFunctions& best_rims() noexcept;

}  // namespace palpate::simd
