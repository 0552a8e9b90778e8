// Declares what a Potree 2.0 store says of its points and nodes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/tile/plan.hpp"
#include "io/tile/tree.hpp"

namespace palpate::io::tile {

struct Hierarchy {
  std::vector<std::byte> bytes;  ///< hierarchy.bin
  std::size_t first_chunk = 0;   ///< bytes
  int depth = 0;                 ///< the deepest level
};

/// All nodes, in any order; the parent of each is among them.
[[nodiscard]] Hierarchy hierarchy_of(std::vector<StoreNode> nodes, const Layout& layout);

/// metadata.json.
[[nodiscard]] std::string metadata_of(const Plan& plan, const Hierarchy& hierarchy,
                                      const std::string& name);

}  // namespace palpate::io::tile
