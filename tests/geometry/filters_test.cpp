#include <gtest/gtest.h>

#include <cmath>

#include "geometry/clouds.hpp"
#include "geometry/normals.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/weights.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Clouds;
using test::Points;

TEST(Clip, KeepsWhatIsInsideWithAllItsColumns) {
  PointCloud cloud;
  cloud.origin = Vector3d(1000, 0, 0);
  for (int i = 0; i < 10; ++i) {
    cloud.positions.push_back(Vector3f(static_cast<float>(i), 0, 0));
    cloud.intensities.push_back(static_cast<float>(i));
    cloud.colors.push_back({static_cast<std::uint8_t>(i), 0, 0});
  }
  Box box;
  box.extend(Vector3d(1003, -1, -1));
  box.extend(Vector3d(1005, 1, 1));
  const PointCloud clipped = clip(cloud, box);
  ASSERT_EQ(clipped.size(), 3u);
  EXPECT_EQ(clipped.origin, cloud.origin);
  EXPECT_EQ(clipped.intensities, (std::vector<float>{3, 4, 5}));
  EXPECT_EQ(clipped.colors[2][0], 5);
  EXPECT_TRUE(clipped.normals.empty());
  EXPECT_TRUE(clip(cloud, Box{}).empty());
}

std::vector<std::uint8_t> mask_of(const CellGrid& grid) {
  const std::vector<float> radii = support_radii(local_spacings(grid));
  return speckle_mask(grid, radii, WeightSums(grid, radii));
}

TEST(Speckle, IsWhatFloatsAroundASurfaceAndNothingOfIt) {
  Clouds clouds;
  Points points = clouds.plane(60, 2e-3, 0.3);
  const std::size_t surface = points.size();
  for (int i = 0; i < 4; ++i) {
    points.push_back(Vector3f(0.04f * static_cast<float>(i), 0.03f * static_cast<float>(3 - i),
                              0.015f + 0.04f * static_cast<float>(i)));
  }
  const CellGrid grid(points);
  const auto mask = mask_of(grid);
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) {
    if ((mask[k] != 0) != (grid.order()[k] >= surface)) ++wrong;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(Speckle, LeavesALineAndASphereAlone) {
  Points line;
  for (int i = 0; i < 100; ++i) line.push_back(Vector3f(0.01f * static_cast<float>(i), 0, 0));
  for (const Points& points : {line, Clouds(2).sphere(3000, 0.1)}) {
    std::size_t dropped = 0;
    for (const auto speckle : mask_of(CellGrid(points))) dropped += speckle;
    EXPECT_EQ(dropped, 0u);
  }
}

TEST(WeightSums, WantARadiusForEachPoint) {
  const CellGrid grid(Clouds(1).plane(3, 1));
  EXPECT_THROW(WeightSums(grid, std::vector<float>(3, 1.f)), Error);
  EXPECT_THROW(WeightSums(grid, std::vector<float>(9, 0.f)), Error);
}

TEST(WeightSums, FollowRadiiThatChangeAsIfSummedAnew) {
  Clouds clouds(3);
  const CellGrid grid(clouds.sphere(4000, 1));
  const std::vector<float> before(grid.size(), 0.1f);
  std::vector<float> after = before;
  for (const std::size_t i : {7u, 8u, 2000u, 3999u}) {
    after[i] = static_cast<float>(clouds.uniform(0.02, 0.3));
  }
  WeightSums sums(grid, before);
  sums.update(grid, before, after);
  const WeightSums anew(grid, after);
  EXPECT_EQ(sums.own, anew.own);
  EXPECT_EQ(sums.around, anew.around);
}

TEST(SupportRadii, AreTheLargestOfSpacingNoiseAndMinimum) {
  const std::vector<float> spacings{1e-3f, 2e-3f, 4e-3f};
  const auto expect = [&](SupportOptions options, std::size_t i, double radius) {
    EXPECT_NEAR(support_radii(spacings, options)[i], radius, 1e-8);
  };
  SupportOptions options;
  expect(options, 0, 2.5e-3);
  expect(options, 2, 10e-3);
  options.minimum = 6e-3;
  expect(options, 0, 6e-3);
  options = {};
  options.multiple = 4;
  expect(options, 1, 8e-3);
  options = {};
  options.noise = 0.35e-3;  // above 0.15 of the median spacing: m = 3
  options.normal_error = 1;
  expect(options, 1, 6e-3);
  options.normal_error = 0.02;
  expect(options, 1, std::sqrt(3.2 * 0.35e-3 * 2e-3 / 0.02));
  options.footprint = 8e-3;
  expect(options, 0, 6e-3);  // six spacings of its own and no more
  options.most_spacings = 100;
  expect(options, 1, std::sqrt(3.2 * 0.35e-3 * 8e-3 / 0.02));
  options.finest_shape = 7e-3;
  expect(options, 1, 7e-3);
  expect(options, 2, 12e-3);  // its spacing needs more
}

TEST(SupportRadii, FollowFieldChoiceSection5) {
  // sigma_n 0.62 mm, delta 1.98 mm: theta = 2, 1, 0.7 degrees need 10.6, 15, 18 mm.
  const double degree = 3.14159265 / 180;
  EXPECT_NEAR(noise_radius(0.62e-3, 1.98e-3, 2 * degree), 10.6e-3, 0.1e-3);
  EXPECT_NEAR(noise_radius(0.62e-3, 1.98e-3, 1 * degree), 15.0e-3, 0.1e-3);
  EXPECT_NEAR(noise_radius(0.62e-3, 1.98e-3, 0.7 * degree), 18.0e-3, 0.1e-3);
  EXPECT_EQ(support_multiple(0.1, 1), 2.5);
  EXPECT_EQ(support_multiple(0.2, 1), 3);
  EXPECT_EQ(support_multiple(0.5, 1), 4);
}

TEST(SupportRadii, RefuseOptionsWithoutSense) {
  const std::vector<float> spacings{1};
  std::vector<SupportOptions> bad(4);
  bad[0].multiple = 0;
  bad[1].noise = -1;
  bad[2].normal_error = 0;
  bad[3].finest_shape = 0;
  for (const SupportOptions& options : bad) {
    EXPECT_THROW((void)support_radii(spacings, options), Error);
  }
  EXPECT_TRUE(support_radii({}).empty());
}

}  // namespace
}  // namespace palpate
