// Declares how sorted points become nodes of an octree, from the leaves up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/tile/frame.hpp"

namespace palpate::io::tile {

/// A node whose points are settled.
struct StoreNode {
  Cell cell;
  std::uint32_t points = 0;
  std::uint64_t place = 0;  ///< of its first byte among those of its file
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

/// Joins branches to their parent. It takes a subsample of their points, one spacing apart: the
/// first along the curve wins. The spacing is 1/128 of the node's edge.
class Joiner {
 public:
  Joiner(const Layout& layout, int bits);

  /// The octree of a cube's sorted records down to leaves of at most `most` points.
  [[nodiscard]] Branch grow(const Cell& cell, std::span<const std::byte> records, std::size_t most,
                            Settled& settled);

  /// The parent; what it leaves to its children is settled.
  [[nodiscard]] Branch join(const Cell& cell, std::vector<Branch> children, Settled& settled);

 private:
  struct Taken {
    Numbers numbers;
    std::uint32_t next;  // the one before in the same small cell; 0: none
  };
  bool take(const Numbers& numbers, int shift, std::uint64_t least);

  Layout layout_;
  int bits_;
  std::vector<std::uint32_t> heads_;  // the last one in each small cell, an edge of 0 around them
  std::vector<Taken> taken_;
};

/// Sorts the records of a chunk along the Morton curve, equal places by what else they hold: so
/// the result does not depend on the order in which they came.
[[nodiscard]] std::vector<std::byte> sort_records(std::span<const std::byte> records,
                                                  const Layout& layout, const Cell& cell, int bits);

}  // namespace palpate::io::tile
