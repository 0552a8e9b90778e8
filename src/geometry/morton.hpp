#pragma once

#include <cstdint>

namespace palpate::detail {

/// A place on a Morton curve through cells numbered along each axis, of which the lower 11 bits
/// count.
inline std::uint64_t morton_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  // Puts two zero bits between any two.
  const auto spread = [](std::uint64_t v) {
    v = (v | (v << 16)) & 0x70000FF;
    v = (v | (v << 8)) & 0x700F00F;
    v = (v | (v << 4)) & 0x430C30C3;
    v = (v | (v << 2)) & 0x49249249;
    return v;
  };
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

}  // namespace palpate::detail
