#pragma once

#include <cstdint>

namespace palpate::detail {

/// Puts two zero bits between any two of the lower 11 bits: a third of a Morton key.
inline std::uint64_t spread(std::uint32_t v) {
  std::uint64_t x = v;
  x = (x | (x << 16)) & 0x70000FF;
  x = (x | (x << 8)) & 0x700F00F;
  x = (x | (x << 4)) & 0x430C30C3;
  x = (x | (x << 2)) & 0x49249249;
  return x;
}

}  // namespace palpate::detail
