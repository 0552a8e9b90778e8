#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

struct Sheet {
  std::vector<Vector3f> positions;
  std::vector<std::uint32_t> codes;
};

// A bumpy sheet of 2^n x 2^n points along a Z-order curve, some places empty, some twice.
Sheet sheet(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Sheet sheet;
  for (std::uint32_t code = 0; code < (1u << (2 * n)); ++code) {
    float u = 0;
    float v = 0;
    for (int bit = 0; bit < n; ++bit) {
      u += static_cast<float>((code >> (2 * bit)) & 1u) * static_cast<float>(1 << bit);
      v += static_cast<float>((code >> (2 * bit + 1)) & 1u) * static_cast<float>(1 << bit);
    }
    const float chance = uniform(random);
    for (int k = 0; k < (chance < 0.1f ? 0 : chance < 0.9f ? 1 : 2); ++k) {
      sheet.positions.push_back({u, v, uniform(random)});
      sheet.codes.push_back(code);
    }
  }
  return sheet;
}

void expect_whole(const CellGrid& grid, const Sheet& sheet) {
  ASSERT_EQ(grid.size(), sheet.positions.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    ASSERT_EQ(grid.points()[i], sheet.positions[i]);
    ASSERT_EQ(grid.order()[i], i);
  }
  ASSERT_EQ(grid.cells()[0].size(), grid.size());
  for (const CellGrid::Cell& cell : grid.cells()) {
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      ASSERT_TRUE((grid.points()[i].array() >= cell.lower.array()).all());
      ASSERT_TRUE((grid.points()[i].array() <= cell.upper.array()).all());
    }
    if (cell.children == 0) continue;
    ASSERT_GE(cell.children, 2u);
    ASSERT_LE(cell.children, 4u);
    std::uint32_t at = cell.begin;
    for (std::uint32_t k = 0; k < cell.children; ++k) {
      ASSERT_EQ(grid.cells()[cell.first_child + k].begin, at);
      at = grid.cells()[cell.first_child + k].end;
    }
    ASSERT_EQ(at, cell.end);
  }
}

TEST(CellGridRebuild, CutsARunAlongACurveIntoCells) {
  CellGrid grid;
  for (const int n : {5, 3, 6, 1, 4}) {
    const Sheet points = sheet(n, static_cast<unsigned>(n));
    grid.rebuild(points.positions, points.codes);
    expect_whole(grid, points);
    const auto large = [](const auto& cell) { return cell.children == 0 && cell.size() > 16; };
    EXPECT_EQ(std::ranges::count_if(grid.cells(), large), 0);
  }
}

TEST(CellGridRebuild, FindsWhatBruteForceFinds) {
  const Sheet points = sheet(5, 9);
  CellGrid grid;
  grid.rebuild(points.positions, points.codes);
  std::vector<std::uint32_t> found;
  for (const float radius : {0.5f, 2.0f, 7.0f}) {
    for (std::size_t q = 0; q < points.positions.size(); q += 37) {
      const Vector3f center = points.positions[q] + Vector3f(0.3f, -0.2f, 0.1f);
      found.clear();
      grid.within(center, radius, found);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < points.positions.size(); ++i) {
        if ((points.positions[i] - center).squaredNorm() <= radius * radius) expected.push_back(i);
      }
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(CellGridRebuild, PointsWithOneCodeStayTogether) {
  CellGrid grid;
  const std::vector<Vector3f> positions(100, Vector3f(1, 2, 3));
  grid.rebuild(positions, std::vector<std::uint32_t>(100, 7));
  ASSERT_EQ(grid.cells().size(), 1u);
  EXPECT_EQ(grid.cells()[0].size(), 100u);
}

TEST(CellGridRebuild, NoPointsAreNoCells) {
  CellGrid grid;
  const Sheet points = sheet(3, 1);
  grid.rebuild(points.positions, points.codes);
  grid.rebuild({}, {});
  EXPECT_EQ(grid.size(), 0u);
  EXPECT_TRUE(grid.cells().empty());
}

TEST(CellGridRebuild, UsesItsMemoryAgain) {
  CellGrid grid;
  const Sheet large = sheet(6, 2);
  grid.rebuild(large.positions, large.codes);
  const Vector3f* const points = grid.points().data();
  const CellGrid::Cell* const cells = grid.cells().data();
  const Sheet small = sheet(5, 3);
  grid.rebuild(small.positions, small.codes);
  EXPECT_EQ(grid.points().data(), points);
  EXPECT_EQ(grid.cells().data(), cells);
}

}  // namespace
}  // namespace palpate
