#include <gtest/gtest.h>

#include <vector>

#include "io/cloud_builder.hpp"

namespace palpate::io {
namespace {

Eigen::Vector3d origin_of(const std::vector<Eigen::Vector3d>& points) {
  return choose_origin(points.size(), [&](std::size_t i) { return points[i]; });
}

std::vector<Eigen::Vector3d> line(const Eigen::Vector3d& start, double step, int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(start + Eigen::Vector3d(i * step, 0, 0));
  return points;
}

TEST(Origin, StaysAtZeroNearZero) {
  EXPECT_EQ(origin_of(line({0, 0, 0}, 0.01, 100)), Eigen::Vector3d::Zero());
  EXPECT_EQ(origin_of(line({0, 0, 2}, 0.01, 100)), Eigen::Vector3d::Zero());  // a camera's cloud
  EXPECT_EQ(origin_of({}), Eigen::Vector3d::Zero());
  EXPECT_EQ(origin_of({Eigen::Vector3d::Zero()}), Eigen::Vector3d::Zero());
}

TEST(Origin, IsARoundPointNearFarClouds) {
  const Eigen::Vector3d utm(512345.678, 4612345.678, 123.4);
  const Eigen::Vector3d origin = origin_of(line(utm, 1, 1000));
  EXPECT_EQ(origin, Eigen::Vector3d(513000, 4612000, 0));
  const Eigen::Vector3d part = origin_of(line({25, 0, 0}, 1e-4, 1000));  // 0.1 m, 25 m away
  EXPECT_NEAR(part.x(), 25.05, 0.051);
}

TEST(Origin, IsNotMisledByStrayPoints) {
  std::vector<Eigen::Vector3d> points = line({500000, 4600000, 100}, 1, 900);
  points.insert(points.begin(), 30, Eigen::Vector3d::Zero());
  points.push_back(Eigen::Vector3d::Constant(9e11));
  points.push_back(Eigen::Vector3d::Constant(std::nan("")));
  const Eigen::Vector3d origin = origin_of(points);
  EXPECT_LT((origin - Eigen::Vector3d(500450, 4600000, 100)).norm(), 1000);
}

TEST(Origin, IsFiniteForPointsWithoutExtent) {
  for (const double x : {1.0, 4.6e6, 1e12, 1e-300, 5e-324}) {
    const Eigen::Vector3d point(x, -x, 0);
    const Eigen::Vector3d origin = origin_of({point, point});
    ASSERT_TRUE(origin.allFinite()) << x;
    EXPECT_LE((origin - point).norm(), 1e-7 * x + 1e-12) << x;
  }
}

}  // namespace
}  // namespace palpate::io
