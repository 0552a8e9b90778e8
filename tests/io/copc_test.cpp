// Octrees of COPC files are what the file's chunks hold, and damaged ones are refused.
#include "io/copc.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "io/copc_bytes.hpp"
#include "io/in_cubes.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

io::Input input_of(const std::string& bytes, const ReadOptions& options) {
  return {std::as_bytes(std::span(bytes)), "a.copc.laz", options};
}

std::optional<io::Copc> read(const std::string& bytes) {
  const ReadOptions options;
  const io::Input input = input_of(bytes, options);
  return io::read_copc(input, io::read_las_header(input), io::parts_of(input.bytes));
}

std::string refusal_of(const std::string& bytes) {
  try {
    (void)read(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// Every chunk is a node, and the nodes' points are those of the file read whole.
void expect_all_points(const std::string& bytes, const io::Copc& copc) {
  const ReadOptions options;
  const io::Input input = input_of(bytes, options);
  const io::LasHeader header = io::read_las_header(input);
  const auto all = io::laz::read_points(input, header);
  std::size_t points = 0;
  for (const io::laz::Chunk& chunk : io::laz::read_chunk_table(input, header)) {
    const auto node = std::ranges::find(copc.nodes, chunk.offset, &io::StoredNode::offset);
    ASSERT_NE(node, copc.nodes.end());
    EXPECT_EQ(node->bytes, chunk.bytes);
    const std::vector<io::LasPoint> own =
        io::decode_node(input, header, input.bytes.subspan(node->offset, node->bytes), *node);
    ASSERT_EQ(own.size(), chunk.points);
    for (std::size_t i = 0; i < own.size(); ++i) {
      ASSERT_EQ(own[i].number, all[chunk.first + i].number);
      ASSERT_EQ(own[i].intensity, all[chunk.first + i].intensity);
      ASSERT_EQ(own[i].color, all[chunk.first + i].color);
    }
    points += own.size();
  }
  EXPECT_EQ(points, header.points);
}

TEST(Copc, ListsNodesOfAllPagesByTheirKeys) {
  const std::string bytes = copc_bytes();
  const std::optional<io::Copc> copc = read(bytes);
  ASSERT_TRUE(copc);
  EXPECT_EQ(copc->center, Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(copc->half_size, 64);
  EXPECT_EQ(copc->spacing, 2);
  ASSERT_EQ(copc->nodes.size(), 6u);
  EXPECT_TRUE(std::ranges::is_sorted(copc->nodes, {}, [](const io::StoredNode& each) {
    return std::pair(each.node.level, each.node.cell);
  }));
  EXPECT_EQ(copc->nodes[3].node.points, 0u);
  EXPECT_EQ(copc->nodes[5].node.level, 3);
  EXPECT_EQ(copc->nodes[5].node.cell, (std::array{5, 3, 1}));
  expect_all_points(bytes, *copc);
  EXPECT_EQ(read_text(bytes).declared, 2000u);  // read whole it is LAZ
}

TEST(Copc, OtherFilesHaveNoOctree) {
  EXPECT_FALSE(read(survey_of({.format = 6})));
  EXPECT_FALSE(read(laz_of(survey_of({.format = 6}))));
}

TEST(Copc, RefusesNodesThatCannotBe) {
  const auto spoilt = [](const std::function<void(std::vector<CopcEntry>&)>& change) {
    return refusal_of(copc_bytes(change));
  };
  EXPECT_EQ(spoilt([](auto&) {}), "no error");
  EXPECT_THAT(spoilt([](auto& e) { e[1].key = {1, 2, 0, 0}; }), HasSubstr("no cube of level 1"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].key[0] = 31; }), HasSubstr("no cube of level 31"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].key[0] = -1; }), HasSubstr("no cube of level -1"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].key = e[2].key; }), HasSubstr("1-1-0-0 is listed twice"));
  EXPECT_THAT(spoilt([](auto& e) { e[2].key = {1, 0, 0, 0}; }), HasSubstr("its parent is not"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].place = 1U << 30U; }), HasSubstr("at byte 1073741824"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].bytes = 35; }), HasSubstr("400 points in 35 bytes"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].bytes = -1; }), HasSubstr("fewer than 0 bytes"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].points = -2; }), HasSubstr("fewer than 0 bytes or points"));
  EXPECT_THAT(spoilt([](auto& e) { e[1].points = 399; }), HasSubstr("have 1999 points"));
  EXPECT_THAT(spoilt([](auto& e) { e[4].bytes = 63; }), HasSubstr("a page of 63 bytes"));
  EXPECT_THAT(spoilt([](auto& e) { e[3] = e[4]; }), HasSubstr("is listed twice"));
  EXPECT_THAT(spoilt([](auto& e) { e[4].place += 1U << 30U; }), HasSubstr("a page of 64 bytes at"));
}

TEST(Copc, RefusesAnOctreeWithoutSizeOrRoot) {
  const auto broken = [](std::size_t offset, auto value) {
    std::string bytes = copc_bytes();
    overwrite(bytes, kCopcInfo + offset, value);
    return refusal_of(bytes);
  };
  EXPECT_THAT(broken(24, 0.0), HasSubstr("without a finite size"));
  EXPECT_THAT(broken(24, 1e308), HasSubstr("without a finite")) << "cubes twice as large";
  EXPECT_THAT(broken(0, std::numeric_limits<double>::quiet_NaN()), HasSubstr("without a finite"));
  EXPECT_THAT(broken(40, ~std::uint64_t{0}), HasSubstr("at byte 18446744073709551615"));
  EXPECT_THAT(broken(48, std::uint64_t{0}), HasSubstr("have 0 points"));
}

// Each node may have as many points as it says, but not all of them together.
TEST(Copc, HoldsNoMorePointsInAllThanItsBytesCan) {
  std::string bytes = copc_bytes([](std::vector<CopcEntry>& entries) {
    for (CopcEntry& entry : entries) {
      if (entry.points > 0) entry.points = 2'000'000;
    }
  });
  overwrite<std::uint64_t>(bytes, 247, 5 * 2'000'000);
  EXPECT_THAT(refusal_of(bytes), HasSubstr("10000000 points in a file of"));
}

TEST(Copc, NamesTheNodeThatIsDamaged) {
  const std::string bytes = copc_bytes();
  io::StoredNode node = read(bytes)->nodes[1];
  node.bytes /= 2;
  const ReadOptions options;
  const io::Input input = input_of(bytes, options);
  try {
    (void)io::decode_node(input, io::read_las_header(input),
                          input.bytes.subspan(node.offset, node.bytes), node);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("byte " + std::to_string(node.offset) + ": node 1-0-1-1 ends"));
  }
}

TEST(Copc, PointsOfARealFileLieInTheCubesOfTheirNodes) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA names no folder with the real data";
  const std::filesystem::path path = std::filesystem::path(data) / "pdal_small/lone-star.copc.laz";
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const ReadOptions options;
  const io::Input input = input_of(bytes, options);
  const io::LasHeader header = io::read_las_header(input);
  const std::optional<io::Copc> copc = io::read_copc(input, header, io::parts_of(input.bytes));
  ASSERT_TRUE(copc);
  EXPECT_GT(copc->nodes.size(), 1u);
  expect_all_points(bytes, *copc);
  test::expect_in_cubes(*open_store(path.string()));
}

}  // namespace
}  // namespace palpate
