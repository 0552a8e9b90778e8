#include "palpate/io/synthetic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

TEST(Synthetic, EveryNameMakesACloudOfFinitePointsWithUnitNormals) {
  for (const SyntheticName& name : synthetic_names()) {
    const PointCloud cloud = synthetic_cloud(name.name);
    EXPECT_GT(cloud.size(), 2000u) << name.name;
    ASSERT_EQ(cloud.normals.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_TRUE(cloud.positions[i].allFinite());
      ASSERT_NEAR(cloud.normals[i].norm(), 1, 1e-5);
    }
  }
}

TEST(Synthetic, PointsLieOnTheFormulaWithoutNoise) {
  for (const auto& p : synthetic_cloud("sphere").positions) ASSERT_NEAR(p.norm(), 0.06, 1e-6);
  for (const auto& p : synthetic_cloud("torus").positions) {
    ASSERT_NEAR(std::hypot(std::hypot(p.x(), p.y()) - 0.07f, p.z()), 0.03, 1e-6);
  }
}

TEST(Synthetic, DensityIsOnePointASquareOfTheSpacing) {
  const double spacing = 1.5e-3;
  const double area = 4 * std::numbers::pi * 0.06 * 0.06;
  const PointCloud cloud = synthetic_cloud("sphere", {.spacing = spacing});
  EXPECT_NEAR(static_cast<double>(cloud.size()), area / (spacing * spacing), 2);
}

TEST(Synthetic, NoiseHasTheDeviationWantedAndFollowsTheSeed) {
  const PointCloud cloud = synthetic_cloud("sphere", {.noise = 1e-3, .seed = 7});
  double sum = 0;
  for (const auto& p : cloud.positions) sum += std::pow(p.norm() - 0.06, 2);
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(cloud.size())), 1e-3, 5e-5);
  EXPECT_EQ(synthetic_cloud("sphere", {.noise = 1e-3, .seed = 7}).positions, cloud.positions);
  EXPECT_NE(synthetic_cloud("sphere", {.noise = 1e-3, .seed = 8}).positions, cloud.positions);
}

TEST(Synthetic, UnknownNameListsTheKnownOnes) {
  try {
    (void)synthetic_cloud("horse");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("torus"), std::string::npos);
  }
  EXPECT_THROW((void)synthetic_cloud("torus", {.spacing = 0}), Error);
}

}  // namespace
}  // namespace palpate
