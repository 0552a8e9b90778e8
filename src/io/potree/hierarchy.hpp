// Declares the nodes that the hierarchy.bin of a Potree store lists.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/input.hpp"
#include "io/potree/metadata.hpp"
#include "io/stored_node.hpp"

namespace palpate::io::potree {

/// Potree's name of a node: "r", then the number of a child a level, such as "r0417".
[[nodiscard]] std::string name_of(const PointStore::Node& node);

/// The nodes in the order of their points. The parent of each is among them.
/// @throws Error that names the byte of what is wrong.
[[nodiscard]] std::vector<StoredNode> read_hierarchy(const Input& input, const Metadata& metadata);

/// Checks that all nodes lie within `octree` of `size` bytes, that no two share bytes, and that the
/// bytes can hold their points, which are not more than announced.
/// @throws Error that names the node of what is wrong.
void check_nodes(const std::vector<StoredNode>& nodes, const Metadata& metadata,
                 const std::string& octree, std::size_t size);

}  // namespace palpate::io::potree
