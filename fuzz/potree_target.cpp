// Gives bytes to the reader of Potree stores and checks its promises.
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/potree/potree.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"
#include "support/folder.hpp"
#include "targets.hpp"

namespace palpate::fuzz {
namespace {

void check_that(bool promise, const char* name) {
  if (!promise) throw std::logic_error(name);
}

// Takes up to `size` bytes from the beginning.
std::string take(std::span<const std::byte>& bytes, std::size_t size) {
  const auto part = bytes.first(std::min(size, bytes.size()));
  bytes = bytes.subspan(part.size());
  return {reinterpret_cast<const char*>(part.data()), part.size()};
}

void write_store(const test::Folder& folder, std::span<const std::byte> bytes) {
  std::array<std::size_t, 2> sizes{};
  for (std::size_t& size : sizes) {
    if (bytes.size() < 2) break;
    size = io::load_as<std::uint16_t>(bytes.data());
    bytes = bytes.subspan(2);
  }
  folder.write("metadata.json", take(bytes, sizes[0]));
  folder.write("hierarchy.bin", take(bytes, sizes[1]));
  folder.write("octree.bin", take(bytes, bytes.size()));
}

void check_layout(const PointStore& store) {
  const PointStore::Layout& layout = store.layout();
  std::set<std::pair<std::int32_t, std::array<std::int32_t, 3>>> cubes;
  std::size_t points = 0;
  for (std::size_t i = 0; i < layout.nodes.size(); ++i) {
    const PointStore::Node& node = layout.nodes[i];
    points += node.points;
    check_that(cubes.emplace(node.level, node.cell).second, "two nodes of one cube");
    check_that(!layout.box(i).empty(), "a node without a box");
    for (const std::int32_t c : node.cell) check_that(c >= 0 && c >> node.level == 0, "a cell");
  }
  for (PointStore::Node node : layout.nodes) {
    if (node.level == 0) continue;
    --node.level;
    for (std::int32_t& c : node.cell) c /= 2;
    check_that(cubes.contains({node.level, node.cell}), "a node without a parent");
  }
  check_that(points == layout.points, "nodes that are not all of the store");
}

}  // namespace

CloudFile read_potree(std::span<const std::byte> bytes) {
  const test::Folder folder;
  write_store(folder, bytes);
  check_layout(*io::open_potree(folder.path(), {.scale = 1}));
  return read_cloud_file(folder.path());
}

}  // namespace palpate::fuzz
