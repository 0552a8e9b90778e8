// Declares how sorted points become nodes of an octree, from the leaves up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extras/tile/frame.hpp"

namespace palpate::io::tile {

/// A node whose points are settled.
struct StoreNode {
  Cell cell;
  std::uint32_t points = 0;
  std::uint64_t offset = 0;  ///< of its first byte among those of its file
};

/// A node whose points may still move up, along the Morton curve.
struct Branch {
  Cell cell;
  bool inner = false;  ///< there are nodes below it
  std::vector<std::byte> records;
};

/// Nodes that are settled, and the bytes of their points.
struct Settled {
  std::vector<StoreNode> nodes;
  std::vector<std::byte> bytes;

  /// Adds a node, unless it is a leaf without points.
  void add(const Branch& branch, const Layout& layout);
};

/// What makes nodes of points.
struct Tree {
  Layout layout;
  int bits = 0;          ///< of the root's edge
  std::size_t most = 0;  ///< points of a leaf, unless they have one position

  /// Sorts records along the Morton curve, equal positions by what else they hold: so the result
  /// does not depend on the order in which they came.
  void sort(std::span<std::byte> records) const;

  /// The octree of a cube's sorted records.
  [[nodiscard]] Branch grow(const Cell& cell, std::span<const std::byte> records,
                            Settled& settled) const;

  /// Joins branches to their parent: it takes a subsample of their points, the first along the
  /// curve of each cube of 1/128 of its edge. What it leaves to its children is settled.
  [[nodiscard]] Branch join(const Cell& cell, std::vector<Branch> children, Settled& settled) const;
};

}  // namespace palpate::io::tile
