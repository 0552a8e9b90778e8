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

}  // namespace palpate::test
