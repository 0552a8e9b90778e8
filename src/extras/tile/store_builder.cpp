// Sorts the chunks of a cloud and joins them to one octree on the disk.
#include "extras/tile/store_builder.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "extras/tile/in_order.hpp"
#include "io/file_bytes.hpp"

namespace palpate::io::tile {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kAtOnce = 2;       // chunks that are sorted side by side, for memory
constexpr std::size_t kEntry = 22;       // bytes of a node in hierarchy.bin (format)
constexpr double kSpacingsInEdge = 128;  // (format)

// What the file of a chunk that is done begins with. The nodes follow, then the root's points.
struct Head {
  std::uint64_t octree = 0;  // bytes of octree.bin with this chunk and those before
  std::uint64_t nodes = 0;
  std::uint64_t inner = 0;  // of the root
};

Head head_of(const fs::path& path) {
  Head head;
  const Bytes bytes = OpenFile(path).read(0, sizeof head);
  std::memcpy(&head, bytes.span().data(), sizeof head);
  return head;
}

bool is_within(const Cell& cell, const Cell& around) {
  return cell.level >= around.level && cell_of(cell.at, around.level, cell.level) == around;
}

// All nodes in one chunk: level after level, each along the Morton curve, so the children of a node
// follow those of the nodes before it.
std::vector<std::byte> hierarchy_of(std::vector<StoreNode> nodes, std::size_t record) {
  const auto is_before = [](const Cell& a, const Cell& b) {
    return a.level != b.level ? a.level < b.level : before(a.at, b.at);
  };
  std::ranges::sort(nodes, is_before, &StoreNode::cell);
  std::vector<std::byte> bytes(kEntry * nodes.size());
  LittleEndianWriter out(bytes);
  for (const StoreNode& node : nodes) {
    unsigned mask = 0;
    for (unsigned i = 0; i < 8; ++i) {
      const bool is_there =
          std::ranges::binary_search(nodes, node.cell.child(i), is_before, &StoreNode::cell);
      mask |= is_there ? 1U << i : 0U;
    }
    out.put(static_cast<std::uint8_t>(mask == 0 ? 1 : 0));  // a leaf
    out.put(static_cast<std::uint8_t>(mask));
    out.put(node.points);
    out.put(node.points > 0 ? node.offset : 0);
    out.put(std::uint64_t{node.points * record});
  }
  return bytes;
}

Json list_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json attribute(const char* name, const char* type, std::size_t bytes, const Json& low,
               const Json& high) {
  return {{"name", name},
          {"description", ""},
          {"size", low.size() * bytes},
          {"numElements", low.size()},
          {"elementSize", bytes},
          {"type", type},
          {"min", low},
          {"max", high}};
}

std::string metadata_of(const Plan& plan, std::size_t hierarchy, int depth,
                        const std::string& name) {
  const Frame& frame = plan.frame;
  const Eigen::Vector3d lower = frame.position({});
  // Braces around one value are a list to GCC and the value itself to Clang.
  Json attributes = Json::array();
  attributes.push_back(
      attribute("position", "int32", 4, list_of(lower), list_of(frame.position(plan.highest))));
  if (plan.layout.intensities) {
    attributes.push_back(attribute("intensity", "uint16", 2, Json::array({plan.intensity.low}),
                                   Json::array({plan.intensity.high})));
  }
  if (plan.layout.colors) {
    const auto& c = plan.color;
    attributes.push_back(attribute("rgb", "uint16", 2, {c[0].low, c[1].low, c[2].low},
                                   {c[0].high, c[1].high, c[2].high}));
  }
  const Eigen::Vector3d edge = Eigen::Vector3d::Constant(frame.edge());
  const Json data = {
      {"version", "2.0"},
      {"name", name},
      {"description", ""},
      {"points", plan.points},
      {"projection", "LOCAL_CS[\"of its own, in metres\",UNIT[\"metre\",1]]"},
      {"hierarchy", {{"firstChunkSize", hierarchy}, {"stepSize", 4}, {"depth", depth}}},
      {"offset", list_of(lower)},
      {"scale", list_of(Eigen::Vector3d::Constant(frame.step))},
      {"spacing", frame.edge() / kSpacingsInEdge},
      {"boundingBox", {{"min", list_of(lower)}, {"max", list_of(lower + edge)}}},
      {"encoding", "DEFAULT"},
      {"attributes", attributes}};
  return data.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::size_t count_done(const Plan& plan, const fs::path& work) {
  std::size_t done = 0;
  while (done < plan.chunks.size() && fs::exists(work / std::to_string(done))) ++done;
  return done;
}

}  // namespace

// Cuts off what of octree.bin no file of a chunk records.
StoreBuilder::StoreBuilder(const Plan& plan, std::size_t most, const fs::path& work)
    : plan_(plan),
      tree_{plan.layout, plan.frame.bits, most},
      work_(work),
      done_(count_done(plan, work)),
      octree_(work / "octree.bin", done_ == 0 ? 0 : head_of(file(done_ - 1)).octree) {}

fs::path StoreBuilder::file(std::size_t chunk) const {
  return work_ / std::to_string(chunk);
}

void StoreBuilder::sort_chunks(const Report& report) {
  const std::size_t first = done_;
  in_order(
      plan_.chunks.size() - first, kAtOnce, [&](std::size_t i) { return grow(first + i); },
      [&](Grown& grown) {
        take(done_, grown);
        report(static_cast<double>(++done_) / static_cast<double>(plan_.chunks.size()));
      });
}

StoreBuilder::Grown StoreBuilder::grow(std::size_t chunk) const {
  Grown grown;
  const fs::path path = work_ / "points" / std::to_string(chunk);
  Bytes records;
  if (fs::exists(path)) {
    const OpenFile points(path);
    records = points.read(0, points.size());
  }
  tree_.sort(records.span());
  grown.settled.bytes.reserve(records.size());
  grown.root = tree_.grow(plan_.chunks[chunk], records.span(), grown.settled);
  return grown;
}

void StoreBuilder::take(std::size_t chunk, Grown& grown) {
  append(grown.settled);
  octree_.sync();
  const std::vector<StoreNode>& nodes = grown.settled.nodes;
  const Head head{octree_.size(), nodes.size(), grown.root.inner ? 1U : 0U};
  const auto bytes_of = [](const auto& some) { return std::as_bytes(std::span(some)); };
  write_file(file(chunk), {bytes_of(std::span(&head, 1)), bytes_of(nodes), grown.root.records});
  fs::remove(work_ / "points" / std::to_string(chunk));
}

void StoreBuilder::append(Settled& settled) {
  for (StoreNode& node : settled.nodes) node.offset += octree_.size();
  octree_.append(settled.bytes);
}

// Adds the nodes of a chunk that is done; gives its root.
Branch StoreBuilder::read(std::size_t chunk) {
  const Head head = head_of(file(chunk));
  const OpenFile file(this->file(chunk));
  const std::size_t before = nodes_.size();
  const std::size_t size = head.nodes * sizeof(StoreNode);
  nodes_.resize(before + head.nodes);
  const Bytes bytes = file.read(sizeof head, file.size() - sizeof head);
  std::copy_n(bytes.span().begin(), size,
              std::as_writable_bytes(std::span(nodes_).subspan(before)).begin());
  const auto records = bytes.span().subspan(size);
  return {plan_.chunks[chunk], head.inner != 0, {records.begin(), records.end()}};
}

// `chunk`: the next one along the curve.
Branch StoreBuilder::branch_at(const Cell& cell, std::size_t& chunk) {
  if (plan_.chunks[chunk] == cell) return read(chunk++);
  std::vector<Branch> children;
  for (unsigned i = 0; i < 8; ++i) {
    const Cell child = cell.child(i);
    if (chunk < plan_.chunks.size() && is_within(plan_.chunks[chunk], child)) {
      children.push_back(branch_at(child, chunk));
    }
  }
  Settled settled;
  Branch parent = tree_.join(cell, std::move(children), settled);
  append(settled);
  nodes_.insert(nodes_.end(), settled.nodes.begin(), settled.nodes.end());
  return parent;
}

void StoreBuilder::finish(const std::string& name) {
  std::size_t chunk = 0;
  Settled settled;
  settled.add(branch_at({}, chunk), plan_.layout);
  append(settled);
  nodes_.insert(nodes_.end(), settled.nodes.begin(), settled.nodes.end());
  octree_.sync();
  const int depth =
      std::ranges::max(nodes_, {}, [](const StoreNode& n) { return n.cell.level; }).cell.level;
  const std::vector<std::byte> hierarchy = hierarchy_of(std::move(nodes_), plan_.layout.size());
  write_file(work_ / "hierarchy.bin", {hierarchy});
  const std::string metadata = metadata_of(plan_, hierarchy.size(), depth, name);
  write_file(work_ / "metadata.json", {std::as_bytes(std::span(metadata))});
}

}  // namespace palpate::io::tile
