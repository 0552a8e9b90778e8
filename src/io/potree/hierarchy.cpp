// Reads the hierarchy.bin of a Potree store.
#include "io/potree/hierarchy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>
#include <string_view>

#include "io/file_bytes.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::potree {
namespace {

constexpr std::string_view kCopyAgain = "Copy it again, or make the store again";

// Bytes of a node, offsets of its fields, and the types of nodes: the format's. Inner nodes and
// leaves, 0 and 1, differ only in what their mask of children shows.
constexpr std::size_t kNodeSize = 22;
constexpr std::size_t kMask = 1;
constexpr std::size_t kPoints = 2;
constexpr std::size_t kOffset = 6;
constexpr std::size_t kBytes = 14;
constexpr std::uint8_t kProxy = 2;

constexpr std::int32_t kDeepest = 30;  // level: 30 bits of a coordinate's 32 (judgement)

// Bit 2 of `number`: the upper half in x; bit 1: in y; bit 0: in z.
PointStore::Node child_of(const PointStore::Node& parent, int number) {
  PointStore::Node child{.level = parent.level + 1};
  for (std::size_t k = 0; k < 3; ++k) {
    child.cell[k] = 2 * parent.cell[k] + ((number >> (2 - k)) & 1);
  }
  return child;
}

class HierarchyReader {
 public:
  explicit HierarchyReader(const Input& input) : input_(input) {}

  std::vector<StoredNode> run(std::size_t first_chunk) {
    add_chunk(0, {}, 0, first_chunk);
    while (!chunks_.empty()) read_chunk();
    std::ranges::stable_sort(nodes_, {}, &StoredNode::offset);
    return std::move(nodes_);
  }

 private:
  // Nodes below one, breadth first, the first of them that one itself.
  struct Chunk {
    PointStore::Node top;
    std::size_t offset = 0;
    std::size_t bytes = 0;
  };

  // `at`: the byte that stores where the chunk is.
  void add_chunk(std::size_t at, const PointStore::Node& top, std::uint64_t offset,
                 std::uint64_t bytes) {
    const std::size_t size = input_.bytes.size();
    if (offset > size || bytes > size - offset || bytes == 0 || bytes % kNodeSize != 0) {
      wrong(at, fmt::format("the nodes below {} are {} bytes at byte {} of a file of {}",
                            name_of(top), bytes, offset, size));
    }
    if (!known_chunks_.insert(offset).second) {
      wrong(at, fmt::format("the nodes at byte {} are below two nodes", offset));
    }
    chunk_bytes_ += bytes;  // so chunks that overlap cannot grow without end
    if (chunk_bytes_ > size) wrong(at, "more bytes in chunks of nodes than in the file");
    chunks_.push_back({top, static_cast<std::size_t>(offset), static_cast<std::size_t>(bytes)});
  }

  void read_chunk() {
    const Chunk chunk = chunks_.back();
    chunks_.pop_back();
    std::vector<PointStore::Node> nodes{chunk.top};  // in their order, children behind all others
    const std::size_t count = chunk.bytes / kNodeSize;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = chunk.offset + i * kNodeSize;
      if (i == nodes.size()) wrong(at, "a node that is no other's child");
      const std::byte* bytes = input_.bytes.data() + at;
      const auto type = load_as<std::uint8_t>(bytes);
      if (type > kProxy) wrong(at, fmt::format("a node of type {}", type));
      const auto offset = load_as<std::uint64_t>(bytes + kOffset);
      const auto size = load_as<std::uint64_t>(bytes + kBytes);
      if (type == kProxy) {
        if (i == 0) wrong(at, "a proxy that stands for itself");
        add_chunk(at, nodes[i], offset, size);
        continue;
      }
      add_children(at, load_as<std::uint8_t>(bytes + kMask), nodes[i], nodes);
      nodes[i].points = size == 0 ? 0 : load_as<std::uint32_t>(bytes + kPoints);
      nodes_.push_back({nodes[i], offset, size});
    }
    if (nodes.size() == count) return;
    wrong(chunk.offset + chunk.bytes, fmt::format("the nodes below {} end before {}",
                                                  name_of(chunk.top), name_of(nodes[count])));
  }

  void add_children(std::size_t at, std::uint8_t mask, const PointStore::Node& parent,
                    std::vector<PointStore::Node>& nodes) const {
    if (mask != 0 && parent.level >= kDeepest) {
      wrong(at, fmt::format("nodes below level {}", kDeepest));
    }
    const PointStore::Node kept = parent;  // it is one of `nodes`, which may move
    for (int i = 0; i < 8; ++i) {
      if (((mask >> i) & 1) != 0) nodes.push_back(child_of(kept, i));
    }
  }

  [[noreturn]] void wrong(std::size_t at, std::string_view what) const {
    fail_at_byte(input_, at, what, kCopyAgain);
  }

  const Input& input_;
  std::vector<StoredNode> nodes_;
  std::vector<Chunk> chunks_;  // still to be read
  std::set<std::size_t> known_chunks_;
  std::size_t chunk_bytes_ = 0;
};

}  // namespace

std::string name_of(const PointStore::Node& node) {
  std::string name = "r";
  for (std::int32_t bit = node.level - 1; bit >= 0; --bit) {
    int number = 0;
    for (const std::int32_t c : node.cell) number = 2 * number + ((c >> bit) & 1);
    name += static_cast<char>('0' + number);
  }
  return name;
}

std::vector<StoredNode> read_hierarchy(const Input& input, const Metadata& metadata) {
  return HierarchyReader(input).run(metadata.first_chunk);
}

void check_nodes(const std::vector<StoredNode>& nodes, const Metadata& metadata,
                 const std::string& octree, std::size_t size) {
  const auto wrong = [&](const std::string& what) {
    throw Error(fmt::format("{}: {}. {}.", octree, what, kCopyAgain));
  };
  std::size_t end = 0;  // of the nodes before
  std::size_t points = 0;
  for (const StoredNode& each : nodes) {
    if (each.bytes == 0) continue;
    const std::string name = name_of(each.node);
    if (each.offset > size || each.bytes > size - each.offset) {
      wrong(fmt::format("ends inside node {}: its {} bytes begin at byte {}, the file has {}", name,
                        each.bytes, each.offset, size));
    }
    if (each.offset < end) wrong(fmt::format("node {} begins inside another one", name));
    end = each.offset + each.bytes;
    points += each.node.points;
    const std::size_t most = metadata.packed ? largest_unpacked(each.bytes) : each.bytes;
    if (std::uint64_t{each.node.points} * metadata.point_size > most) {
      wrong(fmt::format("node {} has {} points in {} bytes, which cannot hold them", name,
                        each.node.points, each.bytes));
    }
  }
  // PotreeConverter drops points of equal position, but announces them.
  if (points > metadata.points) {
    wrong(fmt::format("the nodes have {} points, but metadata.json announces {}", points,
                      metadata.points));
  }
  // Each packed node may be small and unpack to 64 MiB, but not all of them together.
  if (metadata.packed && points > largest_unpacked(size) / metadata.point_size) {
    wrong(fmt::format("{} points in {} bytes, which cannot hold them", points, size));
  }
}

}  // namespace palpate::io::potree
