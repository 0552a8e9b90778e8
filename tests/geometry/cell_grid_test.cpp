#include "palpate/geometry/cell_grid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <nanoflann.hpp>
#include <numeric>

#include "geometry/clouds.hpp"
#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;
using test::Clouds;
using test::Points;

std::vector<std::uint32_t> brute_within(const CellGrid& grid, const Vector3f& c, float radius) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    if (detail::squared_distance(grid.points()[i], c) <= radius * radius) found.push_back(i);
  }
  return found;
}

std::vector<std::pair<float, std::uint32_t>> brute_nearest(const CellGrid& grid, const Vector3f& c,
                                                           std::size_t k) {
  std::vector<std::pair<float, std::uint32_t>> all;
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    all.emplace_back(detail::squared_distance(grid.points()[i], c), i);
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(k, all.size()));
  return all;
}

// Everything that the header says about the layout.
void expect_sound(const CellGrid& grid, const Points& input) {
  ASSERT_EQ(grid.size(), input.size());
  std::vector<std::uint32_t> order(grid.order().begin(), grid.order().end());
  for (std::size_t k = 0; k < order.size(); ++k) ASSERT_EQ(grid.points()[k], input[order[k]]);
  std::sort(order.begin(), order.end());
  for (std::uint32_t k = 0; k < order.size(); ++k) ASSERT_EQ(order[k], k);
  const auto cells = grid.cells();
  std::vector<int> depth(cells.size(), 0);
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    const CellGrid::Cell& cell = cells[c];
    ASSERT_LT(cell.begin, cell.end);
    Vector3f lower = grid.points()[cell.begin];
    Vector3f upper = lower;
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      lower = lower.cwiseMin(grid.points()[i]);
      upper = upper.cwiseMax(grid.points()[i]);
    }
    ASSERT_EQ(cell.lower, lower);
    ASSERT_EQ(cell.upper, upper);
    if (cell.children == 0) continue;
    ASSERT_GE(cell.children, 2u);
    ASSERT_LE(cell.children, 8u);
    ASSERT_GT(cell.first_child, c);
    std::uint32_t at = cell.begin;
    for (std::uint32_t k = cell.first_child; k < cell.first_child + cell.children; ++k) {
      ASSERT_EQ(cells[k].begin, at);
      at = cells[k].end;
      depth[k] = depth[c] + 1;
      ASSERT_LE(depth[k], CellGrid::kMaxDepth);
    }
    ASSERT_EQ(at, cell.end);
  }
}

std::uint32_t biggest_leaf(const CellGrid& grid) {
  std::uint32_t biggest = 0;
  for (const auto& cell : grid.cells()) {
    if (cell.children == 0) biggest = std::max(biggest, cell.size());
  }
  return biggest;
}

void expect_answers(const CellGrid& grid, const Vector3f& center, float radius, std::size_t k) {
  std::vector<std::uint32_t> found;
  grid.within(center, radius, found);
  EXPECT_EQ(found, brute_within(grid, center, radius));
  std::vector<CellGrid::Neighbor> nearest;
  grid.nearest(center, k, nearest);
  const auto expected = brute_nearest(grid, center, k);
  ASSERT_EQ(nearest.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(nearest[i].index, expected[i].second);
    EXPECT_EQ(nearest[i].squared_distance, expected[i].first);
  }
}

TEST(CellGrid, IsSoundAndAnswersAsBruteForceOnASphere) {
  Clouds clouds;
  const Points points = clouds.sphere(3000, 0.1);
  const CellGrid grid(points);
  expect_sound(grid, points);
  EXPECT_LE(biggest_leaf(grid), CellGrid::kLeafPoints);
  for (int q = 0; q < 200; ++q) {
    const Vector3f center = (0.12 * clouds.uniform(0, 1) * clouds.direction()).cast<float>();
    expect_answers(grid, center, static_cast<float>(clouds.uniform(0, 0.05)),
                   1 + static_cast<std::size_t>(q) % 20);
  }
}

struct Adaptor {
  const CellGrid& grid;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return grid.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return grid.points()[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

TEST(CellGrid, FindsTheDistancesThatNanoflannFinds) {
  Clouds clouds;
  const CellGrid grid(clouds.cube(20000, 1));
  const Adaptor adaptor{grid};
  using Metric = nanoflann::L2_Simple_Adaptor<float, Adaptor>;
  const nanoflann::KDTreeSingleIndexAdaptor<Metric, Adaptor, 3, std::uint32_t> tree(3, adaptor,
                                                                                    {10});
  for (int q = 0; q < 300; ++q) {
    const Vector3f c = clouds.cube(1, 1).front();
    std::vector<std::uint32_t> indices(9);
    std::vector<float> squared(9);
    tree.knnSearch(c.data(), 9, indices.data(), squared.data());
    std::vector<CellGrid::Neighbor> nearest;
    grid.nearest(c, 9, nearest);
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_FLOAT_EQ(nearest[k].squared_distance, squared[k]);
    }
  }
}

TEST(CellGrid, HoldsNothingOneOrEqualPoints) {
  const CellGrid empty{Points{}};
  EXPECT_EQ(empty.size(), 0u);
  EXPECT_TRUE(empty.cells().empty());
  expect_answers(empty, Vector3f::Zero(), 1, 3);
  for (const std::size_t count : {1, 2, 17, 1000}) {
    const Points points(count, Vector3f(1, 2, 3));
    const CellGrid grid(points);
    expect_sound(grid, points);
    expect_answers(grid, Vector3f(1, 2, 3), 0, 5);
    expect_answers(grid, Vector3f(1, 2, 4), 0.5f, 5);
    for (std::uint32_t k = 0; k < count; ++k) EXPECT_EQ(grid.order()[k], k) << "ties keep order";
  }
}

TEST(CellGrid, FindsTheNearestOfManyPointsAtFewPlaces) {
  Points points;
  for (int i = 0; i < 2000; ++i) points.push_back(Vector3f(static_cast<float>(i % 5), 0, 0));
  const CellGrid grid(points);
  expect_sound(grid, points);
  for (const std::size_t k : {1, 9, 400, 401, 1300}) {
    for (const float x : {0.0f, 1.9f, 2.0f, 2.5f}) expect_answers(grid, {x, 0, 0}, 1, k);
  }
}

TEST(CellGrid, FollowsDensityOverTwelveOrdersOfMagnitude) {
  Clouds clouds;
  Points points;
  for (double size = 1e6; size > 1e-6; size *= 1e-2) {
    for (const Vector3f& p : clouds.cube(400, size)) points.push_back(p);
  }
  points.push_back(Vector3f(1e30f, 0, 0));
  const CellGrid grid(points);
  expect_sound(grid, points);
  const Points large(50, Vector3f(3e38f, -3e38f, 3e38f));
  expect_sound(CellGrid(large), large);
  Points line;
  for (int i = 0; i < 500; ++i) line.push_back(Vector3f(static_cast<float>(i), 0, 0));
  const CellGrid on_line(line);
  expect_sound(on_line, line);
  EXPECT_LE(biggest_leaf(on_line), CellGrid::kLeafPoints);
}

TEST(CellGrid, RefusesWhatIsNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (const std::size_t place : {0u, 7u, 99u}) {
      Points points(100, Vector3f(1, 2, 3));
      points[place].y() = bad;
      try {
        const CellGrid grid(points);
        FAIL() << "accepted " << bad;
      } catch (const Error& error) {
        EXPECT_NE(std::strstr(error.what(), std::to_string(place).c_str()), nullptr)
            << error.what();
      }
    }
  }
}

TEST(CellGrid, DoesNotDependOnTheNumberOfThreads) {
  Clouds clouds;
  Points points = clouds.sphere(300000, 0.1);  // enough to be sorted in parts
  points.insert(points.end(), 1000, points.front());
  const CellGrid many(points);
  const ThreadLimit one(1);
  const CellGrid alone(points);
  EXPECT_TRUE(std::equal(many.order().begin(), many.order().end(), alone.order().begin()));
  ASSERT_EQ(many.cells().size(), alone.cells().size());
  for (std::size_t c = 0; c < many.cells().size(); ++c) {
    EXPECT_EQ(many.cells()[c].begin, alone.cells()[c].begin);
    EXPECT_EQ(many.cells()[c].first_child, alone.cells()[c].first_child);
  }
}

RC_GTEST_PROP(CellGrid, AnswersAsBruteForceForWhateverPoints, (std::vector<int> numbers)) {
  Points points;  // coarse numbers: many points coincide or line up
  for (std::size_t i = 0; i + 2 < numbers.size(); ++i) {
    points.push_back(Vector3f(static_cast<float>(numbers[i] % 7),
                              static_cast<float>(numbers[i + 1] % 5),
                              static_cast<float>(numbers[i + 2])));
  }
  const CellGrid grid(points);
  const Vector3f center = points.empty() ? Vector3f(0, 0, 0) : points.back();
  std::vector<std::uint32_t> found;
  grid.within(center, 3, found);
  RC_ASSERT(found == brute_within(grid, center, 3));
  std::vector<CellGrid::Neighbor> nearest;
  grid.nearest(center, 5, nearest);
  const auto expected = brute_nearest(grid, center, 5);
  RC_ASSERT(nearest.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    RC_ASSERT(nearest[i].index == expected[i].second);
}

}  // namespace
}  // namespace palpate
