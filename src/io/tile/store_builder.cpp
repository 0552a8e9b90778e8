// Sorts the chunks of a cloud and joins them to one octree on the disk.
#include "io/tile/store_builder.hpp"

#include <array>

#include "io/file_bytes.hpp"
#include "io/tile/chunk_files.hpp"
#include "io/tile/in_order.hpp"
#include "io/tile/metadata.hpp"

namespace palpate::io::tile {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNodeBytes = 25;  // of a settled node in the list of nodes
constexpr std::size_t kRootHead = 9;    // bytes before the points of a chunk's root
constexpr std::size_t kAtOnce = 2;      // chunks that are sorted side by side, for memory

void put(const StoreNode& node, std::span<std::byte> bytes) {
  LittleEndianWriter out(bytes);
  out.put(static_cast<std::uint8_t>(node.cell.level));
  for (const std::uint32_t at : node.cell.at) out.put(at);
  out.put(node.points);
  out.put(node.place);
}

StoreNode node_at(const std::byte* bytes) {
  return {{std::to_integer<int>(bytes[0]), numbers_of(bytes + 1)},
          load_as<std::uint32_t>(bytes + 13),
          load_as<std::uint64_t>(bytes + 17)};
}

bool is_within(const Cell& cell, const Cell& around) {
  return cell.level >= around.level && cell_of(cell.at, around.level, cell.level) == around;
}

}  // namespace

// A chunk that is sorted; its root may still lose points to the levels above.
struct StoreBuilder::Grown {
  Settled settled;
  Branch root;
};

// Makes the levels above the chunks, from the roots of these, which are read one after another.
class StoreBuilder::Top {
 public:
  Top(const Plan& plan, const fs::path& roots, const std::function<void(Settled&)>& settle)
      : plan_(plan), roots_(roots), settle_(settle), joiner_(plan.layout, plan.frame.bits) {}

  void run() {
    settled_.add(branch_at({}), plan_.layout);
    settle_(settled_);
  }

 private:
  Branch branch_at(const Cell& cell) {
    if (plan_.chunks[chunk_].cell == cell) {
      ++chunk_;
      return next_root(cell);
    }
    std::vector<Branch> children;
    for (unsigned i = 0; i < 8; ++i) {
      const Cell child = cell.child(i);
      if (chunk_ < plan_.chunks.size() && is_within(plan_.chunks[chunk_].cell, child)) {
        children.push_back(branch_at(child));
      }
    }
    Branch parent = joiner_.join(cell, std::move(children), settled_);
    settle_(settled_);
    settled_ = {};
    return parent;
  }

  Branch next_root(const Cell& cell) {
    const Bytes head = roots_.read(place_, kRootHead);
    const std::size_t size = load_as<std::uint64_t>(head.span().data() + 1);
    const Bytes records = roots_.read(place_ + kRootHead, size);
    place_ += kRootHead + size;
    return {cell, head.span()[0] != std::byte{0}, {records.span().begin(), records.span().end()}};
  }

  const Plan& plan_;
  OpenFile roots_;
  const std::function<void(Settled&)>& settle_;
  Joiner joiner_;
  Settled settled_;
  std::size_t chunk_ = 0;
  std::size_t place_ = 0;  // of its root, bytes
};

StoreBuilder::StoreBuilder(State& state, const fs::path& work)
    : state_(state),
      plan_(state.plan),
      work_(work),
      octree_(work / "octree.bin", state.octree),
      nodes_(work / "nodes", state.nodes),
      roots_(work / "roots", state.roots) {}

void StoreBuilder::sort_chunks(const Told& told) {
  const std::size_t first = state_.chunks;
  in_order(
      plan_.chunks.size() - first, kAtOnce, [&](std::size_t i) { return grow(first + i); },
      [&](Grown& grown) {
        take(grown);
        told(static_cast<double>(state_.chunks) / static_cast<double>(plan_.chunks.size()));
      });
}

StoreBuilder::Grown StoreBuilder::grow(std::size_t i) const {
  const Chunk& chunk = plan_.chunks[i];
  const std::size_t size = chunk.points * plan_.layout.size();
  std::vector<std::byte> records;
  {
    const Bytes unsorted = OpenFile(chunk_file(work_ / "points", i)).read(0, size);
    records = sort_records(unsorted.span(), plan_.layout, chunk.cell, plan_.frame.bits);
  }
  Grown grown;
  grown.settled.bytes.reserve(size);
  Joiner joiner(plan_.layout, plan_.frame.bits);
  grown.root = joiner.grow(chunk.cell, records, state_.job.leaf_points, grown.settled);
  return grown;
}

// What is on the disk before tile.json says so is cut off again after a stop.
void StoreBuilder::take(Grown& grown) {
  append(grown.settled);
  std::vector<std::byte> listed(kNodeBytes * grown.settled.nodes.size());
  for (std::size_t i = 0; i < grown.settled.nodes.size(); ++i) {
    put(grown.settled.nodes[i], std::span(listed).subspan(i * kNodeBytes));
  }
  nodes_.append(listed);
  std::array<std::byte, kRootHead> head;
  LittleEndianWriter out(head);
  out.put(static_cast<std::uint8_t>(grown.root.inner));
  out.put(std::uint64_t{grown.root.records.size()});
  roots_.append(head);
  roots_.append(grown.root.records);
  for (const OutFile* each : {&octree_, &nodes_, &roots_}) each->sync();
  state_.octree = octree_.size();
  state_.nodes = nodes_.size();
  state_.roots = roots_.size();
  ++state_.chunks;
  save(state_, work_ / "tile.json");
  fs::remove(chunk_file(work_ / "points", state_.chunks - 1));
}

void StoreBuilder::append(Settled& settled) {
  for (StoreNode& node : settled.nodes) node.place += octree_.size();
  octree_.append(settled.bytes);
}

std::vector<StoreNode> StoreBuilder::listed_nodes() const {
  const Bytes listed = OpenFile(work_ / "nodes").read(0, state_.nodes);
  std::vector<StoreNode> nodes;
  for (std::size_t at = 0; at < listed.size(); at += kNodeBytes) {
    nodes.push_back(node_at(listed.span().data() + at));
  }
  return nodes;
}

void StoreBuilder::finish(const std::string& name) {
  std::vector<StoreNode> nodes = listed_nodes();
  const std::function<void(Settled&)> settle = [&](Settled& settled) {
    append(settled);
    nodes.insert(nodes.end(), settled.nodes.begin(), settled.nodes.end());
  };
  Top(plan_, work_ / "roots", settle).run();
  octree_.sync();
  const Hierarchy hierarchy = hierarchy_of(std::move(nodes), plan_.layout);
  const std::string metadata = metadata_of(plan_, hierarchy, name);
  write_file(work_ / "hierarchy.bin", hierarchy.bytes);
  write_file(work_ / "metadata.json", std::as_bytes(std::span(metadata)));
}

}  // namespace palpate::io::tile
