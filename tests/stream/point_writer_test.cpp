// Checks the order of blocks, the entries at each, and the columns that moving points are written
// to.
#include "stream/point_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stream/block_matches.hpp"
#include "stream/block_order.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

TEST(BlockOrder, HasEveryBlockOnceAndRisingCodes) {
  const BlockOrder order = make_block_order(5, 3);
  std::vector<std::uint32_t> blocks = order.blocks;
  std::sort(blocks.begin(), blocks.end());
  ASSERT_EQ(blocks.size(), 15u);
  for (std::uint32_t b = 0; b < 15; ++b) EXPECT_EQ(blocks[b], b);
  EXPECT_TRUE(std::is_sorted(order.codes.begin(), order.codes.end(), std::less_equal<>()));
  EXPECT_EQ(std::vector(order.blocks.begin(), order.blocks.begin() + 4),
            (std::vector<std::uint32_t>{0, 1, 5, 6}));  // the square in the image's corner
}

std::vector<std::size_t> beside(std::size_t block) {
  std::vector<std::size_t> found;
  visit_beside(3, 3, block, [&](std::size_t other) { found.push_back(other); });
  return found;
}

TEST(BlockOrder, ABlockHasEightOthersBesideItAndFewerAtTheImagesEdge) {
  EXPECT_EQ(beside(4), (std::vector<std::size_t>{0, 1, 2, 3, 5, 6, 7, 8}));
  EXPECT_EQ(beside(0), (std::vector<std::size_t>{1, 3, 4}));
}

BlockEntries entries_at(const std::vector<std::uint32_t>& indices, std::size_t blocks) {
  std::vector<Entry> entries;
  for (const std::uint32_t index : indices) entries.push_back(Entry{.index = index});
  BlockEntries listed;
  listed.sort(entries, blocks);
  return listed;
}

std::vector<std::uint32_t> at(const BlockEntries& entries, std::size_t index) {
  return {entries.at(index).begin(), entries.at(index).end()};
}

TEST(BlockEntries, AreListedByPlaceInRisingOrder) {
  const BlockEntries entries = entries_at({2, 0, 2, 3}, 4);
  EXPECT_EQ(at(entries, 0), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(at(entries, 1), (std::vector<std::uint32_t>{}));
  EXPECT_EQ(at(entries, 2), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(at(entries, 3), (std::vector<std::uint32_t>{3}));
}

TEST(BlockEntries, FourThatFollowOneAnotherAreFound) {
  EXPECT_EQ(entries_at({0, 1, 2, 3, 4}, 8).four_at(1), 1u);
  EXPECT_EQ(entries_at({0, 1, 2, 4, 5}, 8).four_at(1), BlockEntries::kNone);     // a gap
  EXPECT_EQ(entries_at({0, 1, 2, 2, 3, 4}, 8).four_at(1), BlockEntries::kNone);  // two at one
  EXPECT_EQ(entries_at({1, 0, 2, 3}, 8).four_at(0), BlockEntries::kNone);        // in disorder
}

PointState state(float x) {
  return {.position = Vector3f(x, 2 * x, -x),
          .normal = Vector3f::UnitZ(),
          .weight = 0.1f * x,
          .radius = 0.01f * x,
          .confidence = 1 / x,
          .presence = std::min(1.0f, 0.2f * x)};
}

PointMotion motion(std::uint32_t k) {
  const auto x = static_cast<float>(k);
  return {state(1 + x), state(1.5f + x), EdgeMotion{}, Entry{}, k};
}

SurfacePoints written(const std::vector<PointMotion>& motions, bool edges = false) {
  SurfacePoints points;
  PointWriter writer;
  PointWriter::Extremes extremes;
  writer.begin(points, 1);
  const std::size_t first = writer.append(motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    writer.write(first + i, motions[i], extremes);
    if (edges) writer.add_edge(first + i, motions[i].edge);
  }
  writer.end(extremes);
  return points;
}

template <class Of>
Floats lanes(const Of& of) {
  return Floats{of(0), of(1), of(2), of(3)};
}

PointStates four(float offset) {
  const auto of = [&](int k) { return state(offset + static_cast<float>(k)); };
  const auto vectors = [&](const auto& member) {
    return Vectors{lanes([&](int k) { return member(of(k)).x(); }),
                   lanes([&](int k) { return member(of(k)).y(); }),
                   lanes([&](int k) { return member(of(k)).z(); })};
  };
  return {vectors([](const PointState& s) { return s.position; }),
          vectors([](const PointState& s) { return s.normal; }),
          lanes([&](int k) { return of(k).weight; }),
          lanes([&](int k) { return of(k).radius; }),
          lanes([&](int k) { return of(k).confidence; }),
          lanes([&](int k) { return of(k).presence; })};
}

TEST(PointWriter, WritesFourAsItWritesEach) {
  const SurfacePoints singly = written({motion(0), motion(1), motion(2), motion(3)});
  SurfacePoints together;
  PointWriter writer;
  PointWriter::Extremes extremes;
  const std::array<std::uint32_t, 4> codes{0, 1, 2, 3};
  writer.begin(together, 1);
  writer.write(writer.append(4), codes.data(), four(1), four(1.5f), extremes);
  writer.end(extremes);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(together.grid.points()[i], singly.grid.points()[i]);
    EXPECT_EQ(together.end_positions[i], singly.end_positions[i]);
    EXPECT_EQ(together.end_normals[i], singly.end_normals[i]);
  }
  EXPECT_EQ(together.density_weights, singly.density_weights);
  EXPECT_EQ(together.radii, singly.radii);
  EXPECT_EQ(together.end_radii, singly.end_radii);
  EXPECT_EQ(together.confidences, singly.confidences);
  EXPECT_EQ(together.presences, singly.presences);
  EXPECT_EQ(together.edges.of_point, singly.edges.of_point);
  EXPECT_EQ(together.smallest_radius, singly.smallest_radius);
  EXPECT_EQ(together.radius, singly.radius);
}

TEST(PointWriter, KnowsTheSmallestRadiusAndHowFarACellReaches) {
  const SurfacePoints points = written({motion(0), motion(1), motion(2)});
  EXPECT_EQ(points.smallest_radius, state(1).radius);
  EXPECT_EQ(points.cell_reach.front(), state(3.5f).radius);  // the root's
  EXPECT_EQ(points.radius, state(2.5f).radius);              // the middle one, at the end
}

TEST(PointWriter, PresencesAreLeftOutWhereAllAreOne) {
  EXPECT_EQ(written({motion(0)}).presences.size(), 1u);
  EXPECT_TRUE(written({motion(5)}).presences.empty());
  EXPECT_TRUE(written({motion(5)}).end_presences.empty());
}

TEST(PointWriter, AnEndWithoutAnEdgeGetsTheOtherEndsPlane) {
  PointMotion beside = motion(0);
  beside.edge.end = {Vector3f::UnitX(), 0.5f, 0.25f};
  const SurfacePoints points = written({motion(0), beside}, true);
  EXPECT_EQ(points.edges.of_point[0], SurfacePoints::Edges::kNone);
  ASSERT_EQ(points.edges.of_point[1], 0u);
  EXPECT_EQ(points.edges.start[0].normal, Vector3f::UnitX());
  EXPECT_EQ(points.edges.start[0].share, 0);
  EXPECT_EQ(points.edges.end[0].share, 0.25f);
}

TEST(PointWriter, NoPointIsASurfaceWithoutPoints) {
  const SurfacePoints points = written({});
  EXPECT_EQ(points.size(), 0u);
  EXPECT_EQ(points.smallest_radius, 0);
  EXPECT_EQ(points.radius, 0);
}

}  // namespace
}  // namespace palpate
