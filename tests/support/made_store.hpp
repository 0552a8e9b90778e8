// Makes stores of clouds, in memory.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "palpate/geometry/point_store.hpp"

namespace palpate {

/// An octree as a tiler makes it: a node keeps the first point in each cell of a grid of 32 cells a
/// side, and has children for the others; a node of few keeps all.
class MadeStore final : public PointStore {
 public:
  explicit MadeStore(PointCloud cloud, std::size_t few = 2000)
      : few_(few), cloud_(std::move(cloud)) {
    Box box;
    for (std::size_t i = 0; i < cloud_.size(); ++i) box.extend(cloud_.point(i));
    layout_.format = "made";
    layout_.origin = cloud_.origin;
    layout_.lower = box.lower;
    layout_.edge = 1.001 * box.size().maxCoeff();
    layout_.spacing = layout_.edge / kCells;
    layout_.points = cloud_.size();
    std::vector<std::uint32_t> all(cloud_.size());
    std::iota(all.begin(), all.end(), 0u);
    add({}, std::move(all));
  }

  [[nodiscard]] const Layout& layout() const override { return layout_; }

  [[nodiscard]] PointCloud read(std::size_t node) const override {
    ++reads_;
    if (on_read) on_read(node);
    return select(cloud_, members_[node]);
  }

  /// How many nodes were read so far.
  [[nodiscard]] std::size_t reads() const { return reads_; }

  /// All points in the order of the store.
  [[nodiscard]] PointCloud whole() const {
    std::vector<std::uint32_t> order;
    for (const auto& members : members_) order.insert(order.end(), members.begin(), members.end());
    return select(cloud_, order);
  }

  std::function<void(std::size_t node)> on_read;  ///< called on any thread

 private:
  static constexpr int kCells = 32;

  [[nodiscard]] std::array<std::int32_t, 3> cell(std::uint32_t i, double edge) const {
    const Eigen::Vector3d at = (cloud_.point(i) - layout_.lower) / edge;
    return {static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())};
  }

  void add(Node node, std::vector<std::uint32_t> points) {
    const double edge = std::ldexp(layout_.edge, -node.level);
    std::array<std::vector<std::uint32_t>, 8> rest;
    std::vector<std::uint32_t> own;
    std::set<std::array<std::int32_t, 3>> taken;
    for (const std::uint32_t i : points) {
      if (points.size() <= few_ || taken.insert(cell(i, edge / kCells)).second) {
        own.push_back(i);
      } else {
        const auto [x, y, z] = cell(i, edge / 2);
        rest[static_cast<std::size_t>(4 * (x & 1) + 2 * (y & 1) + (z & 1))].push_back(i);
      }
    }
    node.points = own.size();
    layout_.nodes.push_back(node);
    members_.push_back(std::move(own));
    for (std::int32_t k = 0; k < 8; ++k) {
      if (rest[static_cast<std::size_t>(k)].empty()) continue;
      const auto [x, y, z] = node.cell;
      add({node.level + 1, {2 * x + (k >> 2), 2 * y + (k >> 1 & 1), 2 * z + (k & 1)}, 0},
          std::move(rest[static_cast<std::size_t>(k)]));
    }
  }

  std::size_t few_;
  PointCloud cloud_;
  Layout layout_;
  std::vector<std::vector<std::uint32_t>> members_;
  mutable std::atomic<std::size_t> reads_{0};
};

}  // namespace palpate
