// Reads nodes of a point store, several at a time, and joins their points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <utility>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"

namespace palpate::detail {

/// Level and cell: which cube of the octree.
using NodeKey = std::pair<std::int32_t, std::array<std::int32_t, 3>>;

[[nodiscard]] inline NodeKey key_of(const PointStore::Node& node) {
  return {node.level, node.cell};
}

/// The cube of the level before that holds a cube.
[[nodiscard]] inline NodeKey above(NodeKey key) {
  --key.first;
  for (std::int32_t& c : key.second) c >>= 1;
  return key;
}

/// The coarsest node that has points, the first of several: they lie all over the cloud, so they
/// give what is the same for all nodes. There has to be one.
[[nodiscard]] std::size_t coarsest_node(const PointStore::Layout& layout);

/// The clouds of some nodes, in their order, read on all cores. Where several are damaged, the
/// first one's error is thrown, or put into `error` and damaged ones are empty.
[[nodiscard]] std::vector<PointCloud> read_nodes(const PointStore& store,
                                                 std::span<const std::size_t> nodes,
                                                 std::exception_ptr* error = nullptr);

/// Adds points with the same origin. A column that some points lack is none. `expected`: points
/// that there will be in all; room is made for them.
void append(const PointCloud& from, PointCloud& to, std::size_t expected = 0);

}  // namespace palpate::detail
