// The neighbourhood graph holds what a test of all pairs finds.
#include "geometry/neighborhood_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/clouds.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using detail::NeighborhoodGraph;
using detail::NeighborRow;
using test::Clouds;

using Rows = std::vector<std::vector<std::uint32_t>>;

std::vector<float> drawn(Clouds& clouds, std::size_t count, double low, double high) {
  std::vector<float> drawn(count);
  for (float& v : drawn) v = static_cast<float>(clouds.uniform(low, high));
  return drawn;
}

/// Copies each row to its first point; empty at others. Checks that each point is in one row.
Rows rows_of(const NeighborhoodGraph& graph) {
  Rows rows(graph.grid().size());
  std::vector<int> seen(rows.size());
  graph.for_each_row([&](const NeighborRow& row) {
    EXPECT_TRUE(row.count >= 1 && row.count <= simd::kQueries);
    for (std::uint32_t q = 0; q < row.count; ++q) ++seen[row.first + q];
    rows[row.first].assign(row.neighbors.begin(), row.neighbors.end());
  });
  EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
  return rows;
}

/// The same by a test of all pairs.
Rows all_pairs(const NeighborhoodGraph& graph, const std::vector<float>& radii,
               const std::vector<float>& supports) {
  Rows rows(graph.grid().size());
  const auto points = graph.grid().points();
  graph.for_each_row([&](const NeighborRow& row) {
    for (std::uint32_t j = 0; j < points.size(); ++j) {
      for (std::uint32_t i = row.first; i < row.first + row.count; ++i) {
        const float squared = detail::squared_distance(points[i], points[j]);
        if (squared > radii[i] * radii[i] && squared > supports[j] * supports[j]) continue;
        rows[row.first].push_back(j);
        break;
      }
    }
  });
  return rows;
}

TEST(NeighborhoodGraph, HoldsWhatATestOfAllPairsFinds) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(2003, 1));  // no multiple of the queries
  const std::vector<float> radii = drawn(clouds, grid.size(), 0.01, 0.3);
  const std::vector<float> supports = drawn(clouds, grid.size(), 0.01, 0.3);
  NeighborhoodGraph graph(grid, radii, supports);
  graph.keep();
  EXPECT_EQ(rows_of(graph), all_pairs(graph, radii, supports));
  NeighborhoodGraph own(grid, radii);
  own.keep();
  EXPECT_EQ(rows_of(own), all_pairs(own, radii, std::vector<float>(grid.size(), 0.f)));
}

TEST(NeighborhoodGraph, HoldsNoLessWhereItKeepsNothing) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(2003, 1));
  const std::vector<float> radii = drawn(clouds, grid.size(), 0.01, 0.3);
  const std::vector<float> supports = drawn(clouds, grid.size(), 0.01, 0.3);
  const NeighborhoodGraph graph(grid, radii, supports);
  const Rows found = rows_of(graph);
  const Rows expected = all_pairs(graph, radii, supports);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(std::ranges::is_sorted(found[i]) && std::ranges::includes(found[i], expected[i]));
  }
}

TEST(NeighborhoodGraph, HoldsMoreOnceItIsWidened) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(2003, 1));
  const std::vector<float> before(grid.size(), 0.1f);
  std::vector<float> radii = before;
  std::vector<float> supports = before;
  for (const std::size_t i : {3u, 700u, 701u, 1999u}) radii[i] = 0.4f;
  for (const std::size_t i : {5u, 900u, 2002u}) supports[i] = 0.5f;
  supports[40] = 0.01f;  // what is smaller now stays
  NeighborhoodGraph graph(grid, before, before);
  graph.keep();
  graph.widen(radii, supports);
  supports[40] = 0.1f;
  EXPECT_EQ(rows_of(graph), all_pairs(graph, radii, supports));
}

TEST(NeighborhoodGraph, IsReadAsWellWhereItIsTooLargeToKeep) {
  const CellGrid grid(Clouds().sphere(12000, 1));  // rows of all points: 18 million neighbours
  NeighborhoodGraph graph(grid, std::vector<float>(grid.size(), 3.f));
  graph.keep();
  std::vector<std::size_t> counts(grid.size());
  graph.for_each_row([&](const NeighborRow& row) { counts[row.first] = row.neighbors.size(); });
  std::size_t rows = 0;
  for (const std::size_t count : counts) {
    EXPECT_TRUE(count == 0 || count == grid.size());
    rows += count > 0 ? 1 : 0;
  }
  EXPECT_GE(rows, grid.size() / simd::kQueries);
}

TEST(NeighborhoodGraph, HoldsTheSameOfBlocksThatAreTooLargeToKeep) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(4000, 1));
  std::vector<float> radii(grid.size(), 0.1f);
  std::fill(radii.begin(), radii.begin() + 2000, 1.2f);  // rows of 1,500 neighbours and more
  const std::vector<float> supports(grid.size(), 0.1f);
  NeighborhoodGraph graph(grid, radii, supports);
  graph.keep();
  EXPECT_EQ(rows_of(graph), all_pairs(graph, radii, supports));
  std::fill(radii.begin() + 2000, radii.begin() + 3000, 1.2f);
  graph.widen(radii, supports);
  EXPECT_EQ(rows_of(graph), all_pairs(graph, radii, supports));
}

TEST(NeighborhoodGraph, DoesNotDependOnTheNumberOfThreads) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(20000, 1));
  const std::vector<float> radii = drawn(clouds, grid.size(), 0.01, 0.05);
  const auto kept = [&] {
    NeighborhoodGraph graph(grid, radii, radii);
    graph.keep();
    return rows_of(graph);
  };
  const Rows many = kept();
  const ThreadLimit one(1);
  EXPECT_EQ(kept(), many);
}

TEST(NeighborhoodGraph, TakesOutliersAndPointsAtOnePosition) {
  std::vector<Eigen::Vector3f> points(300, Eigen::Vector3f(1, 2, 3));
  points.emplace_back(1e6f, 0, 0);
  const CellGrid grid(points);
  const std::vector<float> radii(grid.size(), 0.f);
  NeighborhoodGraph graph(grid, radii);
  graph.keep();
  EXPECT_EQ(rows_of(graph), all_pairs(graph, radii, radii));
  EXPECT_EQ(NeighborhoodGraph(CellGrid(), {}).blocks(), 0u);
}

}  // namespace
}  // namespace palpate
