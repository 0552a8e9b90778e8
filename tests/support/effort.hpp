#pragma once

#include <algorithm>
#include <cstdlib>

namespace palpate::test {

/// How many of `count` repetitions a long test does. The environment variable PALPATE_TEST_EFFORT
/// (1 unless set; 0.1 suits builds with sanitizers) scales it; at least one is done.
inline int effort(int count) {
  const char* text = std::getenv("PALPATE_TEST_EFFORT");
  const double factor = text == nullptr ? 1.0 : std::strtod(text, nullptr);
  return std::max(1, static_cast<int>(count * std::clamp(factor, 0.0, 100.0)));
}

/// Is this a build in which everything takes ten times its time? Then what runs long, of what
/// others test as well, is skipped; this says so.
inline bool is_slow_build() {
  return effort(10) < 10;
}
inline constexpr const char* kSlowBuild = "takes long under sanitizers; of what others test, too";

}  // namespace palpate::test
