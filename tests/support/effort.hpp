#pragma once

#include <algorithm>
#include <cstdlib>

namespace palpate::test {

/// How many times slower than a release build this one computes: 10 with sanitizers or without
/// optimisation, 20 with the thread sanitizer (tests/CMakeLists.txt).
inline constexpr double kSlowness = PALPATE_TEST_SLOWNESS;

/// How many of `count` repetitions a long test does; at least one. A slow build does fewer, and so
/// does everybody who sets the environment variable PALPATE_TEST_EFFORT below 1, as scripts/test.sh
/// does.
inline int effort(int count) {
  const char* text = std::getenv("PALPATE_TEST_EFFORT");
  const double factor = text == nullptr ? 1.0 : std::strtod(text, nullptr);
  return std::max(1, static_cast<int>(count * std::clamp(factor, 0.0, 100.0) / kSlowness));
}

/// Is this a build in which everything takes ten times its time? Then what runs long, of what
/// others test as well, is skipped; this says so.
inline bool is_slow_build() {
  return kSlowness > 1;
}
inline constexpr const char* kSlowBuild = "takes long under sanitizers; of what others test, too";

}  // namespace palpate::test
