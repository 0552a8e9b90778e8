// Declares where the file of a point store holds a node, and how its colours become bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "palpate/geometry/point_store.hpp"

namespace palpate::io {

struct StoredNode {
  PointStore::Node node;
  std::uint64_t offset = 0;  ///< bytes from the start of the file, as that stores it
  std::uint64_t bytes = 0;
};

/// Makes colours bytes, by one rule for all nodes of a store.
struct ColorRule {
  double largest = 0;  ///< of some or all points; up to 255 colours are bytes, else of 16 bits

  [[nodiscard]] std::array<std::uint8_t, 3> operator()(
      const std::array<std::uint16_t, 3>& color) const {
    std::array<std::uint8_t, 3> bytes{};
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned value = color[k];
      bytes[k] =
          static_cast<std::uint8_t>(largest > 255 ? (value + 128) / 257 : std::min(value, 255U));
    }
    return bytes;
  }
};

}  // namespace palpate::io
