#pragma once

// The one file that asks the compiler which machine it compiles for.

namespace palpate {

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
