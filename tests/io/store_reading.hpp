// Reads Potree 2.0 stores of encoding DEFAULT for the tests of their writer, and checks that their
// nodes make a tree.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "io/reading.hpp"

namespace palpate::test {

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Stored {
  std::array<std::int64_t, 3> number{};
  std::uint16_t intensity = 0;
  std::array<std::uint16_t, 3> color{};

  auto operator<=>(const Stored&) const = default;
};

/// Which cube: its level, and which child it is on the way there.
using Name = std::string;

struct StoredNode {
  bool inner = false;
  std::vector<Stored> points;
  std::array<std::int64_t, 3> lower{};  ///< of its cube, in steps
};

struct ReadStore {
  nlohmann::json metadata;
  std::int64_t edge = 0;  ///< of the root, in steps
  std::map<Name, StoredNode> nodes;

  [[nodiscard]] std::vector<Stored> points() const {
    std::vector<Stored> all;
    for (const auto& [name, node] : nodes) {
      all.insert(all.end(), node.points.begin(), node.points.end());
    }
    std::ranges::sort(all);
    return all;
  }
};

class StoreReader {
 public:
  explicit StoreReader(const std::filesystem::path& folder)
      : hierarchy_(contents(folder / "hierarchy.bin")), octree_(contents(folder / "octree.bin")) {
    store_.metadata = nlohmann::json::parse(contents(folder / "metadata.json"));
    const double edge = store_.metadata["boundingBox"]["max"][0].get<double>() -
                        store_.metadata["boundingBox"]["min"][0].get<double>();
    store_.edge = std::llround(edge / store_.metadata["scale"][0].get<double>());
  }

  ReadStore run() {
    EXPECT_EQ(store_.metadata["encoding"], "DEFAULT");
    EXPECT_EQ(store_.metadata["hierarchy"]["stepSize"], 4);
    read_chunk("r", 0, store_.metadata["hierarchy"]["firstChunkSize"]);
    EXPECT_EQ(read_, hierarchy_.size()) << "bytes of the hierarchy that nobody needs, or twice";
    std::size_t depth = 0;
    std::size_t points = 0;
    for (const auto& [name, node] : store_.nodes) {
      depth = std::max(depth, name.size() - 1);
      points += node.points.size();
    }
    EXPECT_EQ(store_.metadata["hierarchy"]["depth"], depth);
    EXPECT_EQ(store_.metadata["points"], points);
    EXPECT_EQ(points * record_size(), octree_.size());
    return std::move(store_);
  }

 private:
  std::size_t record_size() const {
    std::size_t size = 0;
    for (const auto& each : store_.metadata["attributes"]) size += each["size"].get<std::size_t>();
    return size;
  }

  // Breadth first: a name for each entry, in the order in which the entries before promise them.
  void read_chunk(const Name& root, std::size_t place, std::size_t size) {
    ASSERT_LE(place + size, hierarchy_.size());
    ASSERT_TRUE(chunks_.insert(place).second) << "a chunk that is listed twice";
    read_ += size;
    std::vector<Name> names{root};
    for (std::size_t i = 0; i < size / 22; ++i) {
      ASSERT_LT(i, names.size()) << "an entry that no other promises";
      const std::size_t at = place + 22 * i;
      const auto kind = load<std::uint8_t>(hierarchy_, at);
      const auto mask = load<std::uint8_t>(hierarchy_, at + 1);
      const auto offset = load<std::uint64_t>(hierarchy_, at + 6);
      const auto bytes = load<std::uint64_t>(hierarchy_, at + 14);
      const Name name = names[i];
      if (kind == 2) {
        EXPECT_EQ(name.size(), root.size() + 4);
        read_chunk(name, offset, bytes);
        continue;
      }
      EXPECT_EQ(kind, mask == 0 ? 1 : 0);
      for (int k = 0; k < 8; ++k) {
        if ((mask >> k & 1) != 0) names.push_back(name + static_cast<char>('0' + k));
      }
      read_node(name, kind == 0, load<std::uint32_t>(hierarchy_, at + 2), offset, bytes);
    }
    EXPECT_EQ(names.size(), size / 22);
  }

  void read_node(const Name& name, bool inner, std::size_t points, std::size_t place,
                 std::size_t bytes) {
    ASSERT_EQ(bytes, points * record_size());
    ASSERT_LE(place + bytes, octree_.size());
    StoredNode node{inner, {}, {}};
    std::int64_t edge = store_.edge;
    for (const char child : name.substr(1)) {
      edge /= 2;
      for (std::size_t k = 0; k < 3; ++k) node.lower[k] += ((child - '0') >> (2 - k) & 1) * edge;
    }
    for (std::size_t i = 0; i < points; ++i)
      node.points.push_back(point(place + i * record_size()));
    ASSERT_TRUE(store_.nodes.emplace(name, node).second) << name << " is there twice";
  }

  Stored point(std::size_t at) const {
    Stored point;
    for (const auto& each : store_.metadata["attributes"]) {
      const std::string name = each["name"];
      for (std::size_t k = 0; k < 3; ++k) {
        if (name == "position") point.number[k] = load<std::int32_t>(octree_, at + 4 * k);
        if (name == "rgb") point.color[k] = load<std::uint16_t>(octree_, at + 2 * k);
      }
      if (name == "intensity") point.intensity = load<std::uint16_t>(octree_, at);
      at += each["size"].get<std::size_t>();
    }
    return point;
  }

  std::string hierarchy_;
  std::string octree_;
  ReadStore store_;
  std::set<std::size_t> chunks_;
  std::size_t read_ = 0;  // bytes of the hierarchy
};

inline ReadStore read_store(const std::filesystem::path& folder) {
  return StoreReader(folder).run();
}

}  // namespace palpate::test
