// Writes small Potree stores.
#include "io/potree_writer.hpp"

#include <brotli/encode.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <memory>
#include <random>
#include <stdexcept>

#include "io/reading.hpp"

namespace palpate {
namespace {

constexpr int kBits = 20;  // of a number: levels that the tree may have

struct WrittenNode {
  int level = 0;
  std::vector<PotreePoint> points;
  std::array<std::unique_ptr<WrittenNode>, 8> children;
  std::uint64_t place = 0;
  std::uint64_t bytes = 0;
};

std::unique_ptr<WrittenNode> tree_of(const std::vector<PotreePoint>& points, int level,
                                     std::size_t most) {
  auto node = std::make_unique<WrittenNode>();
  node->level = level;
  std::array<std::vector<PotreePoint>, 8> rest;
  for (const PotreePoint& p : points) {
    if (node->points.size() < most) {
      node->points.push_back(p);
      continue;
    }
    std::size_t child = 0;
    for (const std::int32_t number : p.number) {
      child = 2 * child + ((number >> (kBits - 1 - level)) & 1);
    }
    rest[child].push_back(p);
  }
  for (std::size_t i = 0; i < 8; ++i) {
    if (!rest[i].empty()) node->children[i] = tree_of(rest[i], level + 1, most);
  }
  return node;
}

// Bits from `first` on of three numbers side by side, the first number's lowest.
template <class T>
std::uint64_t interleave(const std::array<T, 3>& numbers, int first) {
  std::uint64_t code = 0;
  for (int bit = 0; bit < 16; ++bit) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto number = static_cast<std::uint32_t>(numbers[k]);
      code |= std::uint64_t{number >> (first + bit) & 1U} << (3 * bit + static_cast<int>(k));
    }
  }
  return code;
}

std::string brotli(const std::string& bytes) {
  std::size_t size = BrotliEncoderMaxCompressedSize(bytes.size());
  std::string packed(size, '\0');
  if (BrotliEncoderCompress(5, BROTLI_DEFAULT_WINDOW, BROTLI_MODE_GENERIC, bytes.size(),
                            reinterpret_cast<const std::uint8_t*>(bytes.data()), &size,
                            reinterpret_cast<std::uint8_t*>(packed.data())) == BROTLI_FALSE) {
    throw std::logic_error("brotli");
  }
  packed.resize(size);
  return packed;
}

struct WrittenAttribute {
  std::string name;
  std::string type;
  int numbers;
  int size;  // bytes of a number
};

class PotreeWriter {
 public:
  explicit PotreeWriter(const PotreeWriting& writing) : writing_(writing) {
    attributes_ = {{"position", "int32", 3, 4}, {"classification", "uint8", 1, 1}};
    if (writing.columns) {
      attributes_.push_back({"intensity", "uint16", 1, 2});
      attributes_.push_back({"gps-time", "double", 1, 8});
      attributes_.push_back({"rgb", "uint16", 3, 2});
    }
    if (writing.reversed) std::reverse(attributes_.begin(), attributes_.end());
  }

  PotreeFiles run(const std::vector<PotreePoint>& points) {
    const std::unique_ptr<WrittenNode> root = tree_of(points, 0, writing_.in_node);
    add_points(*root);
    add_chunk(*root);
    const std::size_t first = files_.hierarchy.size();
    while (!proxies_.empty()) {
      const auto [node, at] = proxies_.front();
      proxies_.pop_front();
      const std::size_t place = files_.hierarchy.size();
      add_chunk(*node);
      overwrite<std::uint64_t>(files_.hierarchy, at + 6, place);
      overwrite<std::uint64_t>(files_.hierarchy, at + 14, files_.hierarchy.size() - place);
    }
    describe(points.size(), first);
    return std::move(files_);
  }

 private:
  void add_points(WrittenNode& node) {
    for (const auto& child : node.children) {
      if (child) add_points(*child);
    }
    std::string bytes;
    if (writing_.packed) {
      for (const WrittenAttribute& each : attributes_) {
        for (const PotreePoint& p : node.points) append_packed(bytes, each, p);
      }
      bytes = brotli(bytes);
    } else {
      for (const PotreePoint& p : node.points) {
        for (const WrittenAttribute& each : attributes_) append_plain(bytes, each, p);
      }
    }
    node.place = files_.octree.size();
    node.bytes = bytes.size();
    files_.octree += bytes;
    files_.nodes.push_back(node.points);
  }

  static void append_plain(std::string& bytes, const WrittenAttribute& attribute,
                           const PotreePoint& p) {
    if (attribute.name == "position") {
      for (const std::int32_t number : p.number) append(bytes, number);
    } else if (attribute.name == "rgb") {
      for (const std::uint16_t c : p.color) append(bytes, c);
    } else if (attribute.name == "intensity") {
      append(bytes, p.intensity);
    } else if (attribute.name == "gps-time") {
      append(bytes, 3e8 + p.number[0]);
    } else {
      append(bytes, std::uint8_t{6});
    }
  }

  static void append_packed(std::string& bytes, const WrittenAttribute& attribute,
                            const PotreePoint& p) {
    if (attribute.name == "position") {
      append(bytes, interleave(p.number, 16));
      append(bytes, interleave(p.number, 0));
    } else if (attribute.name == "rgb") {
      append(bytes, interleave(p.color, 0));
    } else {
      append_plain(bytes, attribute, p);
    }
  }

  void add_chunk(const WrittenNode& top) {
    std::deque<const WrittenNode*> waiting{&top};
    while (!waiting.empty()) {
      const WrittenNode& node = *waiting.front();
      waiting.pop_front();
      std::uint8_t mask = 0;
      for (std::size_t i = 0; i < 8; ++i)
        mask |= static_cast<std::uint8_t>(!!node.children[i] << i);
      const bool proxy = mask != 0 && node.level == top.level + writing_.levels;
      if (proxy) proxies_.emplace_back(&node, files_.hierarchy.size());
      const std::uint8_t type = proxy ? 2 : mask == 0 ? 1 : 0;
      append(files_.hierarchy, type);
      append(files_.hierarchy, mask);
      append(files_.hierarchy, static_cast<std::uint32_t>(node.points.size()));
      append(files_.hierarchy, node.place);
      append(files_.hierarchy, node.bytes);
      if (proxy) continue;
      for (const auto& child : node.children) {
        if (child) waiting.push_back(child.get());
      }
    }
  }

  void describe(std::size_t points, std::size_t first_chunk) {
    std::string list;
    for (const WrittenAttribute& each : attributes_) {
      // Zeros where nothing is known: viewers want the ranges.
      std::vector<double> most(static_cast<std::size_t>(each.numbers));
      const std::string least = fmt::format("{}", fmt::join(most, ", "));
      if (each.name == "rgb") most[1] = writing_.largest_color;
      list += fmt::format(
          R"({}{{"name": "{}", "size": {}, "numElements": {}, "elementSize": {}, "type": "{}", )"
          R"("min": [{}], "max": [{}]}})",
          list.empty() ? "" : ", ", each.name, each.numbers * each.size, each.numbers, each.size,
          each.type, least, fmt::join(most, ", "));
    }
    const auto& [x, y, z] = kPotreeOffset;
    files_.metadata = fmt::format(
        R"({{"version": "2.0", "name": "a", "description": "", "points": {}, "projection": "",
"hierarchy": {{"firstChunkSize": {}, "stepSize": {}, "depth": 9}},
"offset": [{}, {}, {}], "scale": [0.001, 0.001, 0.001], "spacing": {},
"boundingBox": {{"min": [{}, {}, {}], "max": [{:.3f}, {:.3f}, {:.3f}]}},
"encoding": "{}", "attributes": [{}]}})",
        points, first_chunk, writing_.levels, x, y, z, kPotreeEdge / 128, x, y, z, x + kPotreeEdge,
        y + kPotreeEdge, z + kPotreeEdge, writing_.packed ? "BROTLI" : "DEFAULT", list);
  }

  PotreeWriting writing_;
  std::vector<WrittenAttribute> attributes_;
  PotreeFiles files_;
  std::deque<std::pair<const WrittenNode*, std::size_t>> proxies_;  // and where they are listed
};

}  // namespace

void PotreeFiles::write(const test::Folder& folder) const {
  folder.write("metadata.json", metadata);
  folder.write("hierarchy.bin", hierarchy);
  folder.write("octree.bin", octree);
}

PotreeFiles potree_of(const std::vector<PotreePoint>& points, const PotreeWriting& writing) {
  return PotreeWriter(writing).run(points);
}

std::vector<PotreePoint> potree_hill(std::size_t count) {
  std::mt19937 random(1);
  std::vector<PotreePoint> points(count);
  for (PotreePoint& p : points) {
    const auto x = static_cast<std::int32_t>(random() >> 12U);
    const auto y = static_cast<std::int32_t>(random() >> 12U);
    p.number = {x, y, 1000 + (x >> 4) + (y >> 5)};
    p.color = {static_cast<std::uint16_t>(x >> 4), static_cast<std::uint16_t>(y >> 4), 257};
    p.intensity = static_cast<std::uint16_t>(random() >> 17U);
  }
  return points;
}

}  // namespace palpate
