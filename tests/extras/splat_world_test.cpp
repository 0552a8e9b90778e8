// What splats cost follows their number, and the shell lies where half of the light is gone.
#include "support/splat_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "extras/splats/splat_shell.hpp"
#include "support/splat_half_light.hpp"

namespace palpate::test {
namespace {

std::vector<Splat> some_ball(std::uint64_t seed, int count = 2000) {
  return make_splats(splat_sphere(0.03), {.count = count, .floaters = 0}, seed);
}

// Samples are what time and memory follow: cells and shares are fewer.
void expect_bounded(const std::vector<Splat>& splats) {
  const SplatShell shell = shell_of(splats);
  EXPECT_LE(shell.samples, kUsualSamples * splats.size());
  EXPECT_LE(shell.cloud.size(), shell.samples);
  EXPECT_LE(shell.far + shell.huge, splats.size());
  for (const Eigen::Vector3f& p : shell.cloud.positions) ASSERT_TRUE(p.allFinite());
  for (const Eigen::Vector3f& n : shell.cloud.normals) {
    ASSERT_TRUE(n.isZero(0) || std::abs(n.norm() - 1) < 1e-5F);
  }
}

TEST(SplatWorld, SkyAndHousesDecideNeitherTheGridNorThePoints) {
  for (std::uint64_t seed = 9101; seed <= 9103; ++seed) {
    const std::vector<Splat> world = make_world(8000, seed);
    std::vector<Splat> ball;
    std::ranges::copy_if(world, std::back_inserter(ball), [](const Splat& splat) {
      return splat.position.norm() < 1.01F * static_cast<float>(kWorldBall);
    });
    const SplatShell alone = shell_of(ball);
    const SplatShell shell = shell_of(world);
    EXPECT_LT(shell.spacing, 2 * alone.spacing);
    EXPECT_LE(shell.samples, kUsualSamples * world.size());
    EXPECT_GT(shell.huge, world.size() / 20);
    EXPECT_LT(shell.huge, world.size() * 2 / 5);
    EXPECT_LT(shell.cloud.size(), 2 * world.size());
    const auto on_ball = std::ranges::count_if(shell.cloud.positions, [](const auto& p) {
      return std::abs(static_cast<double>(p.norm()) - kWorldBall) < 0.05 * kWorldBall;
    });
    const double whole = 4 * std::numbers::pi * std::pow(kWorldBall / shell.spacing, 2);
    EXPECT_GT(static_cast<double>(on_ball), 0.6 * whole);
  }
}

TEST(SplatWorld, TheLargestAreLeftOutAndCounted) {
  std::vector<Splat> splats = some_ball(9104);
  const SplatShell alone = shell_of(splats);
  EXPECT_EQ(alone.huge + alone.far, 0u);
  for (int i = 0; i < 10; ++i) {
    Splat giant = splats[0];
    giant.sigma.setConstant(100);
    giant.opacity = 1;
    splats.push_back(giant);
  }
  const SplatShell shell = shell_of(splats);
  EXPECT_EQ(shell.huge, 10u);
  EXPECT_EQ(shell.far, 0u);
  EXPECT_NEAR(shell.spacing, alone.spacing, 0.05 * alone.spacing);
  EXPECT_NEAR(double(shell.cloud.size()), double(alone.cloud.size()), 0.1 * alone.cloud.size());
  for (std::size_t i = 2000; i < splats.size(); ++i) {  // small, but at the end of the world
    splats[i].sigma = splats[0].sigma;
    splats[i].position.x() = 1e12F;
  }
  EXPECT_EQ(shell_of(splats).far, 10u);
  EXPECT_EQ(shell_of(splats).huge, 0u);
}

TEST(SplatWorld, NoSceneTakesMoreSamplesThanItsNumberAllows) {
  const float most = std::numeric_limits<float>::max();
  std::vector<Splat> splats = some_ball(9105);
  splats[0].position.setConstant(1e30F);
  splats[1].sigma.setConstant(most);
  expect_bounded(splats);
  splats = some_ball(9106);
  for (Splat& splat : splats) splat.sigma.setConstant(most);
  expect_bounded(splats);
  for (Splat& splat : splats) splat.sigma = {0, 1e-30F, 1e12F};  // needles without measure
  expect_bounded(splats);
  for (Splat& splat : splats) splat.sigma.setConstant(1);  // in the size of all
  expect_bounded(splats);
  splats = some_ball(9107);
  for (Splat& splat : splats) splat.position.setZero();
  expect_bounded(splats);
  Random random(9108);
  for (Splat& splat : splats) {
    for (float& sigma : splat.sigma) sigma = static_cast<float>(std::exp(30 * random.normal()));
    splat.position = (std::exp(20 * random.normal()) * random_direction(random)).cast<float>();
    splat.opacity = static_cast<float>(random.uniform());
  }
  expect_bounded(splats);
}

// A flipped bit of a compressed file is one of a chunk's bounds: 256 splats become others.
TEST(SplatWorld, AChunkOfAnotherSizeIsBoundedAndLeavesTheOthersFelt) {
  for (int power = -30; power <= 30; power += 3) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Splat> splats = some_ball(9109, 900);
      for (std::size_t i = 0; i < 256; ++i) {
        splats[i].sigma[axis] *= static_cast<float>(std::pow(10, power));
      }
      expect_bounded(splats);
      EXPECT_GT(shell_of(splats).cloud.size(), 100u) << power;
    }
  }
}

/// How far the shell's points lie above where half of the light is gone, spacings, on the mean.
double bias_of(const SplatShell& shell, const std::vector<Splat>& splats, const SplatShape& shape,
               std::uint64_t seed) {
  Random random(seed);
  double sum = 0;
  int count = 0;
  while (count < 200) {
    const auto i = static_cast<std::size_t>(random.uniform() * double(shell.cloud.size()));
    const SurfacePlace place{shell.cloud.positions[i].cast<double>(),
                             shell.cloud.normals[i].cast<double>()};
    const Eigen::Array3d edge = (place.position.cwiseAbs().array() - 0.05).abs();
    const bool apart = std::abs(shape.distance(place.position)) > 3 * shell.spacing;
    if (apart || (edge < 0.015).count() > 1 || place.normal.isZero()) continue;
    if (const auto height = half_light_at(splats, place, 6 * shell.spacing)) {
      sum -= *height / shell.spacing;
      ++count;
    }
  }
  return sum / count;
}

// Seeds on which nothing was chosen. Light that falls in along the normal, all splats, front to
// back.
TEST(SplatWorld, TheShellLiesWhereHalfOfTheLightIsGone) {
  const SplatLook looks[] = {{.floaters = 0}, {.hidden = 0.3}, {.soft = 1.5e-3, .floaters = 0}};
  const SplatShape shapes[] = {splat_sphere(), splat_box(), splat_sphere(0.04)};
  for (int k = 0; k < 3; ++k) {
    for (std::uint64_t seed = 9111; seed <= 9113; ++seed) {
      const std::vector<Splat> splats = make_splats(shapes[k], looks[k], seed);
      const SplatShell shell = shell_of(splats);
      const double bias = bias_of(shell, splats, shapes[k], seed);
      std::printf("scene %d, seed %d: %.3f spacings\n", k, static_cast<int>(seed), bias);
      EXPECT_LT(std::abs(bias), 0.1) << k << " " << seed;
    }
  }
}

// Half of the light from above is gone above the middle, half of that from below beneath it.
TEST(SplatWorld, ASheetThatIsLitFromBothSidesLiesInItsMiddle) {
  const std::vector<Splat> splats =
      make_splats(splat_plane(), {.soft = 1.5e-3, .floaters = 0}, 9114);
  const SplatShell shell = shell_of(splats);
  double sum = 0;
  double count = 0;
  for (const Eigen::Vector3f& p : shell.cloud.positions) {
    if (p.head<2>().cwiseAbs().maxCoeff() > 0.08F) continue;
    sum += static_cast<double>(p.z()) / shell.spacing;
    ++count;
  }
  EXPECT_GT(count, 1000);
  EXPECT_LT(std::abs(sum / count), 0.1);
}

}  // namespace
}  // namespace palpate::test
