#pragma once

#include <cstddef>

// The one file that reads from the compiler which machine it compiles for.

namespace palpate {

/// Floats that one instruction takes, where this unit is compiled for: sums must not depend on it.
#if defined(__AVX__)
constexpr std::size_t kFloatsAtOnce = 8;
#else
constexpr std::size_t kFloatsAtOnce = 4;
#endif

/// Does this processor run code that was compiled for x86-64-v3 (AVX2, FMA, BMI)? False elsewhere.
[[nodiscard]] inline bool cpu_has_v3() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
#else
  return false;
#endif
}

}  // namespace palpate
