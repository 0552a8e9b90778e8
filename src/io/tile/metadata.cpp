// Encodes hierarchy.bin and metadata.json of a Potree 2.0 store.
#include "io/tile/metadata.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace palpate::io::tile {
namespace {

constexpr std::size_t kEntry = 22;       // bytes of a node (format)
constexpr int kStepSize = 4;             // levels of a chunk (format)
constexpr double kSpacingsInEdge = 128;  // (format)
enum class Kind : std::uint8_t { inner = 0, leaf = 1, proxy = 2 };

class HierarchyEncoder {
 public:
  HierarchyEncoder(std::vector<StoreNode> nodes, const Layout& layout)
      : nodes_(std::move(nodes)), layout_(layout) {
    std::ranges::sort(nodes_, {}, &StoreNode::cell);
  }

  Hierarchy run() {
    // Chunks are listed before any is written, as proxies say where those behind them are.
    chunks_.push_back(list_chunk(nodes_.front()));
    starts_[nodes_.front().cell] = {0, kEntry * chunks_.front().size()};
    std::size_t size = kEntry * chunks_.front().size();
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
      const int last = chunks_[i].front()->cell.level + kStepSize;
      for (std::size_t k = 0; k < chunks_[i].size(); ++k) {
        const StoreNode& node = *chunks_[i][k];
        if (node.cell.level < last || children_of(node) == 0) continue;
        chunks_.push_back(list_chunk(node));
        starts_[node.cell] = {size, kEntry * chunks_.back().size()};
        size += kEntry * chunks_.back().size();
      }
    }
    Hierarchy hierarchy{std::vector<std::byte>(size), kEntry * chunks_.front().size(),
                        nodes_.back().cell.level};
    std::span<std::byte> rest = hierarchy.bytes;
    for (const Listed& chunk : chunks_) {
      for (const StoreNode* node : chunk) {
        const bool proxy = node->cell.level == chunk.front()->cell.level + kStepSize;
        put(*node, proxy, rest.first(kEntry));
        rest = rest.subspan(kEntry);
      }
    }
    return hierarchy;
  }

 private:
  using Listed = std::vector<const StoreNode*>;
  struct Start {
    std::uint64_t place = 0;
    std::uint64_t size = 0;
  };

  [[nodiscard]] const StoreNode* find(const Cell& cell) const {
    const auto at = std::ranges::lower_bound(nodes_, cell, {}, &StoreNode::cell);
    return at != nodes_.end() && at->cell == cell ? &*at : nullptr;
  }

  [[nodiscard]] unsigned children_of(const StoreNode& node) const {
    unsigned mask = 0;
    for (unsigned i = 0; i < 8; ++i) mask |= find(node.cell.child(i)) != nullptr ? 1U << i : 0U;
    return mask;
  }

  // A node and those up to four levels below it, breadth first.
  [[nodiscard]] Listed list_chunk(const StoreNode& root) const {
    Listed listed{&root};
    for (std::size_t i = 0; i < listed.size(); ++i) {
      if (listed[i]->cell.level == root.cell.level + kStepSize) break;
      for (unsigned k = 0; k < 8; ++k) {
        if (const StoreNode* child = find(listed[i]->cell.child(k))) listed.push_back(child);
      }
    }
    return listed;
  }

  void put(const StoreNode& node, bool proxy, std::span<std::byte> entry) const {
    const unsigned mask = children_of(node);
    const Kind kind = mask == 0 ? Kind::leaf : proxy ? Kind::proxy : Kind::inner;
    LittleEndianWriter out(entry);
    out.put(static_cast<std::uint8_t>(kind));
    out.put(static_cast<std::uint8_t>(mask));
    out.put(node.points);
    const Start own{node.points > 0 ? node.place : 0, node.points * layout_.size()};
    const Start start = kind == Kind::proxy ? starts_.at(node.cell) : own;
    out.put(start.place);
    out.put(start.size);
  }

  std::vector<StoreNode> nodes_;
  const Layout& layout_;
  std::vector<Listed> chunks_;
  std::map<Cell, Start> starts_;  // of chunks in hierarchy.bin, by their roots
};

using Json = nlohmann::ordered_json;

Json list_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json attribute(const char* name, std::size_t numbers, std::size_t bytes, const char* type,
               const Json& low, const Json& high) {
  return {{"name", name},
          {"description", ""},
          {"size", numbers * bytes},
          {"numElements", numbers},
          {"elementSize", bytes},
          {"type", type},
          {"min", low},
          {"max", high}};
}

}  // namespace

Hierarchy hierarchy_of(std::vector<StoreNode> nodes, const Layout& layout) {
  return HierarchyEncoder(std::move(nodes), layout).run();
}

std::string metadata_of(const Plan& plan, const Hierarchy& hierarchy, const std::string& name) {
  const Frame& frame = plan.frame;
  const auto place = [&](const Numbers& n) -> Eigen::Vector3d {
    return frame.lower + frame.step * Eigen::Vector3d(n[0], n[1], n[2]);
  };
  Json attributes = Json::array({attribute("position", 3, 4, "int32", list_of(place(plan.lowest)),
                                           list_of(place(plan.highest)))});
  if (plan.layout.intensities) {
    attributes.push_back(attribute("intensity", 1, 2, "uint16", Json::array({plan.intensity.low}),
                                   Json::array({plan.intensity.high})));
  }
  if (plan.layout.colors) {
    const auto& c = plan.color;
    attributes.push_back(attribute("rgb", 3, 2, "uint16", {c[0].low, c[1].low, c[2].low},
                                   {c[0].high, c[1].high, c[2].high}));
  }
  const Eigen::Vector3d edge = Eigen::Vector3d::Constant(frame.edge());
  const Json data = {
      {"version", "2.0"},
      {"name", name},
      {"description", ""},
      {"points", plan.points},
      {"projection", ""},
      {"hierarchy",
       {{"firstChunkSize", hierarchy.first_chunk},
        {"stepSize", kStepSize},
        {"depth", hierarchy.depth}}},
      {"offset", list_of(frame.lower)},
      {"scale", list_of(Eigen::Vector3d::Constant(frame.step))},
      {"spacing", frame.edge() / kSpacingsInEdge},
      {"boundingBox", {{"min", list_of(frame.lower)}, {"max", list_of(frame.lower + edge)}}},
      {"encoding", "DEFAULT"},
      {"attributes", attributes}};
  return data.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::io::tile
