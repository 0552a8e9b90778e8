#include <gtest/gtest.h>

#include "base/numbers.hpp"
#include "depth/window_fits.hpp"
#include "support/effort.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const depth::BlockGrid kGrid = depth::block_grid({160, 120, {131, 133, 70, 66}, {}});

/// Depths from 0.3 to 2 m, one in ten missing.
depth::Blocks random_blocks(Random& random) {
  depth::Blocks blocks;
  blocks.resize(kGrid);
  for (int row = 0; row < kGrid.rows; ++row) {
    for (int column = 0; column < kGrid.columns; ++column) {
      const bool hole = random.uniform() < 0.1;
      const double z = 0.3 + 1.7 * random.uniform();
      blocks.rho[blocks.at(column, row)] = hole ? 0 : static_cast<float>(1 / z);
    }
  }
  return blocks;
}

TEST(FitRegion, HoldsTheBlocksInTheBalls) {
  Random random(3);
  const depth::Blocks blocks = random_blocks(random);
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  T_world_sensor.linear() = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).matrix();
  T_world_sensor.translation() = Vector3d(0.3, -2, 1);
  for (int repeat = 0; repeat < effort(200); ++repeat) {
    std::vector<Ball> balls;
    for (int i = 0; i <= repeat % 3; ++i) {
      const Vector3d local(3 * random.uniform() - 1.5, 3 * random.uniform() - 1.5,
                           2.5 * random.uniform() - 0.5);
      balls.push_back({T_world_sensor * local, 0.02 + 0.4 * random.uniform()});
    }
    depth::FitRegion region;
    region.set(kGrid, T_world_sensor, balls);
    for (int row = 0; row < kGrid.rows; ++row) {
      std::vector<std::int32_t> expected;
      for (int column = 0; column < kGrid.columns; ++column) {
        const float rho = blocks.rho[blocks.at(column, row)];
        if (!(rho > 0)) continue;
        const Vector3d p = T_world_sensor * (Vector3d(kGrid.x(column), kGrid.y(row), 1) / rho);
        for (const Ball& ball : balls) {
          if ((p - ball.center).norm() > ball.radius) continue;
          expected.push_back(column);
          break;
        }
      }
      std::vector<std::int32_t> columns(static_cast<std::size_t>(kGrid.columns));
      const int count = region.columns(blocks, {}, row, columns.data());
      columns.resize(static_cast<std::size_t>(count));
      ASSERT_EQ(columns, expected) << "row " << row << " of repetition " << repeat;
    }
  }
}

TEST(FitRegion, IsEmptyWithoutBallsInView) {
  depth::FitRegion region;
  region.set(kGrid, Eigen::Isometry3d::Identity(), {});
  EXPECT_TRUE(region.range().empty());
  const std::vector<Ball> behind = {{{0, 0, -1}, 0.5}};
  region.set(kGrid, Eigen::Isometry3d::Identity(), behind);
  EXPECT_TRUE(region.range().empty());
  const std::vector<Ball> nowhere = {{Vector3d::Constant(std::nan("")), 1}, {{0, 0, 1}, -1}};
  region.set(kGrid, Eigen::Isometry3d::Identity(), nowhere);
  EXPECT_TRUE(region.range().empty());
}

TEST(FitRegion, IsEverythingRoundTheCamera) {
  depth::FitRegion region;
  const std::vector<Ball> balls = {{{0, 0, 0}, 5}};
  region.set(kGrid, Eigen::Isometry3d::Identity(), balls);
  EXPECT_EQ(region.range(), (depth::BlockRange{0, 0, kGrid.columns, kGrid.rows}));
}

}  // namespace
}  // namespace palpate::test
