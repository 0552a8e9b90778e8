// Reads nodes of a store, several at a time, and forgets those that were not requested longest.

#include "large/node_cache.hpp"

#include <algorithm>
#include <utility>

#include "geometry/store_nodes.hpp"

namespace palpate {
namespace {

std::size_t bytes_of(const PointCloud& cloud) {
  return cloud.positions.size() * sizeof(cloud.positions[0]) +
         cloud.normals.size() * sizeof(cloud.normals[0]) +
         cloud.colors.size() * sizeof(cloud.colors[0]) +
         cloud.intensities.size() * sizeof(cloud.intensities[0]);
}

bool meet(const Box& a, const Box& b) {
  return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

}  // namespace

NodeCache::NodeCache(std::shared_ptr<const PointStore> store, std::size_t room)
    : store_(std::move(store)), room_(room) {}

std::vector<std::size_t> NodeCache::nodes_at(const Box& box) const {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < layout().nodes.size(); ++k) {
    if (layout().nodes[k].points > 0 && meet(layout().box(k), box)) found.push_back(k);
  }
  return found;
}

std::size_t NodeCache::points_around(const Box& box) const {
  std::size_t points = 0;
  for (const std::size_t k : nodes_at(box)) points += layout().nodes[k].points;
  return points;
}

PointCloud NodeCache::inside(const Box& box) {
  ++calls_;
  const std::vector<std::size_t> nodes = nodes_at(box);
  read(nodes);
  PointCloud cloud;
  cloud.origin = layout().origin;
  for (const std::size_t k : nodes) detail::append(clip(kept_.at(k).cloud, box), cloud);
  forget_oldest();
  return cloud;
}

void NodeCache::read(std::span<const std::size_t> nodes) {
  std::vector<std::size_t> missing;
  for (const std::size_t k : nodes) {
    const auto found = kept_.find(k);
    if (found == kept_.end())
      missing.push_back(k);
    else
      found->second.used = calls_;
  }
  std::vector<PointCloud> clouds = detail::read_nodes(*store_, missing);
  for (std::size_t k = 0; k < missing.size(); ++k) {
    size_ += bytes_of(clouds[k]);
    kept_[missing[k]] = {std::move(clouds[k]), calls_};
  }
}

void NodeCache::forget_oldest() {
  if (size_ <= room_) return;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;  // when it was used, node
  for (const auto& [node, kept] : kept_) order.emplace_back(kept.used, node);
  std::ranges::sort(order);
  for (const auto& [used, node] : order) {
    if (size_ <= room_) return;
    size_ -= bytes_of(kept_.at(node).cloud);
    kept_.erase(node);
  }
}

}  // namespace palpate
