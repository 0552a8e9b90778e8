#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "geometry/clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Clouds;

PointCloud with_columns(std::vector<Vector3f> positions) {
  PointCloud cloud;
  cloud.origin = Vector3d(4e5, 5e6, 100);
  cloud.viewpoint = Vector3d(1, 2, 3);
  Clouds clouds(9);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    cloud.normals.push_back(clouds.direction().cast<float>());
    cloud.intensities.push_back(static_cast<float>(i % 10));
    cloud.colors.push_back({static_cast<std::uint8_t>(i % 256), 255, 0});
  }
  cloud.positions = std::move(positions);
  return cloud;
}

// Cubes in a map, sums in double precision.
void expect_as_map(const PointCloud& cloud, double leaf) {
  std::map<std::tuple<long, long, long>, std::vector<std::size_t>> cubes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto at = [&](int axis) {
      return static_cast<long>(std::floor(static_cast<double>(cloud.positions[i][axis]) / leaf));
    };
    cubes[{at(2), at(1), at(0)}].push_back(i);
  }
  std::vector<std::uint32_t> counts;
  const PointCloud result = voxel_downsample(cloud, leaf, &counts);
  ASSERT_EQ(result.size(), cubes.size());
  ASSERT_EQ(counts.size(), cubes.size());
  EXPECT_EQ(result.origin, cloud.origin);
  EXPECT_EQ(result.viewpoint, cloud.viewpoint);
  std::size_t k = 0;
  for (const auto& [place, members] : cubes) {
    Vector3d position = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    double intensity = 0;
    double red = 0;
    for (const std::size_t i : members) {
      position += cloud.positions[i].cast<double>();
      normal += cloud.normals[i].cast<double>();
      intensity += static_cast<double>(cloud.intensities[i]);
      red += cloud.colors[i][0];
    }
    const auto n = static_cast<double>(members.size());
    EXPECT_EQ(counts[k], members.size());
    EXPECT_LT((result.positions[k].cast<double>() - position / n).norm(),
              1e-6 * (1 + position.norm()));
    EXPECT_LT((result.normals[k].cast<double>() - normal.normalized()).norm(), 1e-5);
    EXPECT_NEAR(result.intensities[k], intensity / n, 1e-5);
    EXPECT_NEAR(result.colors[k][0], red / n, 0.51);
    EXPECT_EQ(result.colors[k][1], 255);
    ++k;
  }
}

TEST(VoxelGrid, GivesTheMeansThatAMapOfCubesGives) {
  const PointCloud cloud = with_columns(Clouds(1).cube(3000, 1));
  for (const double leaf : {0.03, 0.1, 0.33, 5.}) expect_as_map(cloud, leaf);
  expect_as_map(with_columns(Clouds(2).sphere(2000, 3, Vector3d(-1, -2, 100))), 0.25);
}

TEST(VoxelGrid, SortsKeysOfMoreBitsThanOneSortTakes) {
  auto points = Clouds(3).sphere(500, 100);
  const auto twice = points;
  points.insert(points.end(), twice.begin(), twice.end());
  expect_as_map(with_columns(points), 2e-3);  // 100,000 cubes along each axis
}

TEST(VoxelGrid, KeepsNothingAndOnePoint) {
  EXPECT_TRUE(voxel_downsample(PointCloud{}, 1).empty());
  const PointCloud one = voxel_downsample(with_columns({Vector3f(1, 2, 3)}), 0.5);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one.positions[0], Vector3f(1, 2, 3));
}

TEST(VoxelGrid, LeavesNormalsThatCancelAtZero) {
  PointCloud cloud = with_columns({Vector3f(0, 0, 0), Vector3f(0, 0, 0)});
  cloud.normals = {Vector3f(0, 0, 1), Vector3f(0, 0, -1)};
  EXPECT_TRUE(voxel_downsample(cloud, 1).normals[0].isZero());
}

TEST(VoxelGrid, SaysWhyALeafIsAbsurd) {
  PointCloud cloud;
  cloud.positions = {Vector3f(0, 0, 0), Vector3f(1000, 0, 0)};
  for (const double leaf :
       {0., -1., std::nan(""), std::numeric_limits<double>::infinity(), 1e-4, 1e-300}) {
    EXPECT_THROW((void)voxel_downsample(cloud, leaf), Error) << leaf;
  }
  try {
    (void)voxel_downsample(cloud, 1e-4);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("0.000482"), std::string::npos) << error.what();
  }
  EXPECT_EQ(voxel_downsample(cloud, 4.82e-4).size(), 2u);
  cloud.positions[1].x() = std::nanf("");
  EXPECT_THROW((void)voxel_downsample(cloud, 1), Error);
}

TEST(VoxelGrid, DoesNotDependOnTheNumberOfThreads) {
  const PointCloud cloud = with_columns(Clouds(4).sphere(300000, 1));
  const PointCloud many = voxel_downsample(cloud, 0.01);
  const ThreadLimit one(1);
  const PointCloud alone = voxel_downsample(cloud, 0.01);
  EXPECT_EQ(many.positions, alone.positions);
  EXPECT_EQ(many.normals, alone.normals);
}

}  // namespace
}  // namespace palpate
