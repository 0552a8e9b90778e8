#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "apps/palpate/info/info_command.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate::app {
namespace {

TEST(DensityMap, LooksAlongTheShortestSideAndLosesNoPoint) {
  const PointCloud cloud = synthetic_cloud("sheet");
  const DensityMap map = map_density(cloud, 72);
  EXPECT_EQ(map.horizontal, 0);
  EXPECT_EQ(map.vertical, 1);
  EXPECT_EQ(std::accumulate(map.counts.begin(), map.counts.end(), std::size_t{0}), cloud.size());
}

TEST(DensityMap, HoleIsBlankAndUpIsUp) {
  PointCloud cloud;
  for (int i = 0; i < 4000; ++i) {
    const float x = static_cast<float>(i % 80) / 80;
    const float y = static_cast<float>(i / 80) / 50;
    if (x > 0.5f && y > 0.5f) continue;  // upper right
    cloud.positions.emplace_back(x, y, 0.f);
  }
  const std::string text = draw(map_density(cloud, 40), false);
  const std::string first = text.substr(0, text.find('\n'));
  const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  EXPECT_LT(first.size() + 10, last.size());
}

TEST(DensityMap, OnePointIsOneLetter) {
  PointCloud cloud;
  cloud.origin = {1e6, 0, 0};
  cloud.positions = {{0, 0, 0}};
  EXPECT_EQ(draw(map_density(cloud, 72), false), "  @\n");
}

TEST(DensityMap, OutlierIsLeftOut) {
  PointCloud cloud = synthetic_cloud("bumps");
  const DensityMap before = map_density(cloud, 40);
  cloud.positions.push_back({500, -300, 200});
  const DensityMap after = map_density(cloud, 40);
  EXPECT_NEAR(after.cell, before.cell, 0.02 * before.cell);
  EXPECT_NEAR(after.rows, before.rows, 1);
  const auto empty = [](const DensityMap& map) { return std::ranges::count(map.counts, 0u); };
  EXPECT_LT(empty(after), 80) << empty(before);  // two rows
}

}  // namespace
}  // namespace palpate::app
