// Declares a writer of small Potree stores.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "support/folder.hpp"

namespace palpate {

struct PotreePoint {
  std::array<std::int32_t, 3> number{};  ///< 0 ... 2^20 - 1; place = number * 0.001 + offset
  std::array<std::uint16_t, 3> color{};
  std::uint16_t intensity = 0;

  auto operator<=>(const PotreePoint&) const = default;  // NOLINT(modernize-use-nullptr): its 0
};

inline constexpr std::array<double, 3> kPotreeOffset{4e5, 5.5e6, 100};  // m
inline constexpr double kPotreeEdge = 1048.576;                         // m, of the root's cube

struct PotreeWriting {
  bool packed = false;       ///< BROTLI
  int levels = 4;            ///< of a chunk of nodes
  std::size_t in_node = 50;  ///< points; the rest goes to children
  bool columns = true;       ///< colours and intensities, too
  bool reversed = false;     ///< the attributes
  double largest_color = 0;  ///< as metadata.json says; 0: nothing
};

struct PotreeFiles {
  std::string metadata;
  std::string hierarchy;
  std::string octree;
  std::vector<std::vector<PotreePoint>> nodes;  ///< in the order of octree.bin

  void write(const test::Folder& folder) const;
};

/// A store of the points: a node has the first ones in its cube that none above it has. Children
/// lie before their parents in octree.bin.
[[nodiscard]] PotreeFiles potree_of(const std::vector<PotreePoint>& points,
                                    const PotreeWriting& writing = {});

/// Points on a hill in the cube; some low, all different.
[[nodiscard]] std::vector<PotreePoint> potree_hill(std::size_t count);

}  // namespace palpate
