// Lists where the nodes of a point store are, reads some and joins them.
#include "palpate/geometry/point_store.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "geometry/parallel.hpp"
#include "geometry/store_nodes.hpp"

namespace palpate {

Box PointStore::Layout::box(std::size_t node) const {
  const std::array<std::int32_t, 3>& cell = nodes[node].cell;
  const double length = std::ldexp(edge, -nodes[node].level);
  const Eigen::Vector3d size(length, length, flatness * length);
  const Eigen::Vector3d at = lower + size.cwiseProduct(Eigen::Vector3d(cell[0], cell[1], cell[2]));
  return {at, at + size};
}

Box PointStore::Layout::box() const {
  return {lower, lower + Eigen::Vector3d(edge, edge, flatness * edge)};
}

namespace detail {
namespace {

/// `before`: points that are there already.
template <class T>
void append(const std::vector<T>& from, std::size_t before, std::size_t expected,
            std::vector<T>& to) {
  if (from.empty() || to.size() != before) {
    to = {};
    return;
  }
  if (expected > 0) to.reserve(expected);
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::size_t coarsest_node(const PointStore::Layout& layout) {
  const auto height = [](const PointStore::Node& node) {
    return std::pair(node.points == 0, node.level);
  };
  const auto found = std::ranges::min_element(layout.nodes, {}, height);
  return static_cast<std::size_t>(found - layout.nodes.begin());
}

std::vector<PointCloud> read_nodes(const PointStore& store, std::span<const std::size_t> nodes,
                                   std::exception_ptr* first) {
  std::vector<PointCloud> clouds(nodes.size());
  std::vector<std::exception_ptr> errors(nodes.size());
  parallel_each(nodes.size(), 1, [&](std::size_t i) {
    try {
      clouds[i] = store.read(nodes[i]);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  const auto found =
      std::ranges::find_if(errors, [](const auto& error) { return error != nullptr; });
  if (found != errors.end() && first == nullptr) std::rethrow_exception(*found);
  if (found != errors.end()) *first = *found;
  return clouds;
}

void append(const PointCloud& from, PointCloud& to, std::size_t expected) {
  if (from.empty()) return;
  const std::size_t before = to.size();
  to.origin = from.origin;
  append(from.positions, before, expected, to.positions);
  append(from.normals, before, expected, to.normals);
  append(from.colors, before, expected, to.colors);
  append(from.intensities, before, expected, to.intensities);
}

}  // namespace detail
}  // namespace palpate
