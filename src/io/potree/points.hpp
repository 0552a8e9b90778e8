// Declares the points of a Potree store as they are stored.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/potree/hierarchy.hpp"
#include "io/potree/metadata.hpp"

namespace palpate::io::potree {

struct RawPoint {
  std::array<std::int32_t, 3> number{};  ///< position = number * scale + offset
  std::array<std::uint16_t, 3> color{};  ///< red, green, blue
  float intensity = 0;                   ///< finite
};

/// The points of a node, given its bytes. `octree`: the file's name.
/// @throws Error for packed bytes that are damaged.
[[nodiscard]] std::vector<RawPoint> decode(const Metadata& metadata, const StoredNode& node,
                                           std::span<const std::byte> bytes,
                                           const std::string& octree);

}  // namespace palpate::io::potree
