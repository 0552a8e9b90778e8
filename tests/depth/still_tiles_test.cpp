// Checks what the depth filter keeps of its last answer.
#include "depth/still_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "depth/small_frames.hpp"

namespace palpate::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Frames until blocks average as many as they will: eight times the memory, and some to spare.
constexpr int kSettled = 90;

const std::vector<Solid> kWall = {plane({0, 0, 0.7}, {0.2, 0.1, -1})};

// A filter that has seen the wall for so long that it knows it.
class KeptTilesTest : public testing::Test {
 protected:
  explicit KeptTilesTest(int memory = 8) : filter_(with(memory)) {}

  static DepthFilterOptions with(int memory) {
    DepthFilterOptions options;
    options.noise = kinect_like_noise();
    options.memory = memory;
    return options;
  }

  const FilteredDepth& show(const std::vector<Solid>& solids,
                            const Isometry3d& pose = Isometry3d::Identity()) {
    return filter_.filter(noisy_frame(solids, {}, number_++), pose);
  }

  void settle() {
    for (int k = 0; k < kSettled; ++k) show(kWall);
  }

  static double kept(const FilteredDepth& depth) {
    const auto& flags = depth.kept.flags;
    return double(std::count(flags.begin(), flags.end(), 1)) / double(flags.size());
  }

  DepthFilter filter_;
  std::uint64_t number_ = 0;
};

TEST_F(KeptTilesTest, AreMostOfAStillScene) {
  EXPECT_EQ(kept(show(kWall)), 0);
  settle();
  EXPECT_GT(kept(show(kWall)), 0.5);  // a fifth lies along the image's border
}

TEST_F(KeptTilesTest, HaveTheAnswerOfTheFrameBeforeBitForBit) {
  settle();
  const FilteredDepth before = show(kWall);
  const FilteredDepth& now = show(kWall);
  ASSERT_GT(kept(now), 0.5);
  for (int row = 0; row < now.rows; ++row) {
    for (int column = 0; column < now.columns; ++column) {
      if (!now.kept.at(column, row)) continue;
      const auto i = static_cast<std::size_t>(row * now.columns + column);
      ASSERT_EQ(now.states[i], before.states[i]);
      ASSERT_EQ(now.positions[i], before.positions[i]);
      ASSERT_EQ(now.normals[i], before.normals[i]);
      ASSERT_EQ(now.deviations[i], before.deviations[i]);
    }
  }
}

TEST_F(KeptTilesTest, TakeTurnsInBeingFilteredAgain) {
  settle();
  std::vector<std::uint8_t> ever_filtered(show(kWall).kept.flags.size(), 0);
  for (int k = 0; k < 16; ++k) {
    const auto& flags = show(kWall).kept.flags;
    for (std::size_t i = 0; i < flags.size(); ++i) ever_filtered[i] |= flags[i] == 0 ? 1 : 0;
  }
  EXPECT_EQ(std::count(ever_filtered.begin(), ever_filtered.end(), 0), 0);
}

TEST_F(KeptTilesTest, AreNoneWhereSomethingComes) {
  settle();
  std::vector<Solid> with_ball = kWall;
  with_ball.push_back(sphere({0, 0, 0.66}, 0.03));
  const FilteredDepth& depth = show(with_ball);
  EXPECT_GT(kept(depth), 0.3);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double from_axis = depth.positions[i].head<2>().norm();
    const int column = static_cast<int>(i) % depth.columns;
    if (from_axis > 0.02) continue;
    EXPECT_FALSE(depth.kept.at(column, static_cast<int>(i) / depth.columns));
    EXPECT_LT(depth.positions[i].z(), 0.66);
  }
}

TEST_F(KeptTilesTest, AreNoneWhereBlocksVanish) {
  settle();
  DepthFrame frame = noisy_frame(kWall, {}, number_++);
  for (int row = 40; row < 60; ++row) {
    for (int column = 60; column < 90; ++column) frame.depth[row * 160 + column] = 0;
  }
  const FilteredDepth& depth = filter_.filter(frame, Isometry3d::Identity());
  for (int row = 21; row < 29; ++row) {
    for (int column = 31; column < 44; ++column) {
      EXPECT_EQ(depth.states[static_cast<std::size_t>(row * depth.columns + column)],
                FilteredDepth::State::empty);
    }
  }
}

TEST_F(KeptTilesTest, AreNoneOfACameraThatMoves) {
  settle();
  Isometry3d pose = Isometry3d::Identity();
  pose.translation().x() = 1e-5;
  EXPECT_EQ(kept(show(kWall, pose)), 0);
}

TEST_F(KeptTilesTest, AreNoneOfAFilterThatWasReset) {
  settle();
  filter_.reset();
  EXPECT_EQ(kept(show(kWall)), 0);
}

TEST_F(KeptTilesTest, AreNoneWhereTheRegionToBeFittedChanges) {
  settle();
  const std::vector<Ball> ball = {{{0, 0, 0.7}, 0.02}};
  const DepthFrame frame = noisy_frame(kWall, {}, number_++);
  const FilteredDepth& depth = filter_.filter(frame, Isometry3d::Identity(), ball);
  EXPECT_EQ(kept(depth), 0);  // all were fitted before
  const auto middle = static_cast<std::size_t>(depth.rows / 2 * depth.columns + depth.columns / 2);
  EXPECT_EQ(depth.states[middle], FilteredDepth::State::fitted);
  EXPECT_EQ(depth.states[0], FilteredDepth::State::plain);
}

TEST_F(KeptTilesTest, AreTheSameOfAFrameThatComesAgain) {
  settle();
  const DepthFrame frame = noisy_frame(kWall, {}, number_++);
  const std::vector<std::uint8_t> before = filter_.filter(frame, Isometry3d::Identity()).kept.flags;
  EXPECT_EQ(filter_.filter(frame, Isometry3d::Identity()).kept.flags, before);
}

// At 9.4 m and beyond, five deviations of a time-of-flight camera are as much as all of its inverse
// depth.
TEST(StillTiles, HoldHolesApartFromWhatIsFar) {
  const NoiseModel noise = sensor_noise("tof");
  const depth::BlockGrid grid = depth::block_grid(kSmall);
  depth::Blocks blocks;
  blocks.resize(grid);
  depth::StillTiles tiles;
  tiles.forget(grid);
  const std::vector<std::uint8_t> settled(static_cast<std::size_t>(grid.columns), 1);
  KeptTiles found;
  const auto count = [&] {
    tiles.find(blocks, noise, {}, 8, found);
    return std::count(found.flags.begin(), found.flags.end(), 1);
  };
  for (int row = 0; row < grid.rows; ++row) {
    std::fill_n(&blocks.rho[blocks.at(0, row)], grid.columns, 1 / 15.0F);
    tiles.remember(blocks, row, 0, grid.columns, settled.data());
  }
  const auto whole = count();
  EXPECT_GT(whole, 200);
  for (int row = 1; row < grid.rows; row += 4) {
    for (int column = 2; column < grid.columns; column += 4) blocks.rho[blocks.at(column, row)] = 0;
  }
  EXPECT_EQ(count(), 0);
}

class WithoutMemory : public KeptTilesTest {
 protected:
  WithoutMemory() : KeptTilesTest(1) {}
};

TEST_F(WithoutMemory, NothingIsKept) {
  settle();
  EXPECT_EQ(kept(show(kWall)), 0);
}

// Errors of a wall's depth, m.
struct WallErrors {
  double mean = 0;
  double rms = 0;
};

WallErrors errors_of(const FilteredDepth& depth, double z) {
  WallErrors errors;
  int count = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth.states[i] == FilteredDepth::State::empty) continue;
    const double off = depth.positions[i].z() - z;
    errors.mean += off;
    errors.rms += off * off;
    ++count;
  }
  errors.mean /= count;
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

std::vector<Solid> wall_at(double z) {
  return {plane({0, 0, z}, {0, 0, -1})};
}

TEST_F(KeptTilesTest, AreAsTrueAsWhatIsFiltered) {
  for (int k = 0; k < kSettled; ++k) show(wall_at(0.7));
  double worst = 0;
  for (int k = 0; k < 32; ++k) worst = std::max(worst, errors_of(show(wall_at(0.7)), 0.7).rms);
  EXPECT_LT(worst, 0.1 * kinect_like_noise().sigma(0.7));
}

// Where neighbouring pixels err together, 64 frames are averaged: at 0.5 mm/s, a wall is 0.77 mm
// behind where every block is filtered in every frame.
TEST(KeptTilesOfCorrelatedNoise, FollowWhatCreeps) {
  DepthFilterOptions options;
  options.noise = sensor_noise("kinect1");
  SimulatedNoiseOptions noise;
  noise.kind = NoiseKind::blurred;
  DepthFilter filter(options);
  double worst = 0;
  for (int k = 0; k < kSettled + 120; ++k) {
    const double z = 0.7 - 0.5e-3 * std::max(0, k - kSettled) / 30;
    const DepthFrame frame = noisy_frame(wall_at(z), noise, static_cast<std::uint64_t>(k));
    const WallErrors errors = errors_of(filter.filter(frame, Isometry3d::Identity()), z);
    if (k > kSettled) worst = std::max(worst, std::abs(errors.mean));
  }
  EXPECT_LT(worst, 1e-3);
}

// Slower than any single frame shows: a pixel's deviation is 0.85 mm. Where every block is filtered
// in every frame, the mean is up to 0.14 mm behind.
TEST_F(KeptTilesTest, FollowWhatCreeps) {
  for (const double speed : {0.5e-3, 2e-3, 5e-3, 20e-3}) {  // m/s
    filter_.reset();
    for (int k = 0; k < kSettled; ++k) show(wall_at(0.7));
    double worst = 0;
    for (int k = 1; k <= 60; ++k) {
      const double z = 0.7 - speed * k / 30;
      worst = std::max(worst, std::abs(errors_of(show(wall_at(z)), z).mean));
    }
    EXPECT_LT(worst, 0.2e-3) << speed;
  }
}

}  // namespace
}  // namespace palpate::test
