#pragma once

#include <cstdint>

#include "base/numbers.hpp"

namespace palpate::accuracy {

/// Even between two bounds.
inline double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

}  // namespace palpate::accuracy
