// Keeps the nodes of a store that were read last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// Nodes of a store in memory, as many as there is room for. One thread uses it.
class NodeCache {
 public:
  /// `room`: bytes.
  NodeCache(std::shared_ptr<const PointStore> store, std::size_t room);

  [[nodiscard]] const PointStore::Layout& layout() const { return store_->layout(); }

  /// All points of the store in a box (the store's frame, m), in the order of the store.
  /// @throws Error as PointStore::read() does.
  [[nodiscard]] PointCloud inside(const Box& box);

  /// The points of all nodes that meet a box, which is more than there are in it.
  [[nodiscard]] std::size_t points_around(const Box& box) const;

 private:
  struct Kept {
    PointCloud cloud;
    std::uint64_t used = 0;  // when; counts calls of inside()
  };

  [[nodiscard]] std::vector<std::size_t> nodes_at(const Box& box) const;
  void read(std::span<const std::size_t> nodes);
  void forget_oldest();

  std::shared_ptr<const PointStore> store_;
  std::size_t room_;
  std::unordered_map<std::size_t, Kept> kept_;
  std::size_t size_ = 0;  // bytes of all that is kept
  std::uint64_t calls_ = 0;
};

}  // namespace palpate
