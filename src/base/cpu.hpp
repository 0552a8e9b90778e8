#pragma once

namespace palpate {

/// Does this processor run code that was compiled for x86-64-v3 (AVX2, FMA, BMI)? False elsewhere.
[[nodiscard]] bool cpu_has_v3() noexcept;

}  // namespace palpate
