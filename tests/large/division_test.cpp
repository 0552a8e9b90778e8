// Blocks are as large as points are sparse, and cost no more than what is in them.

#include "large/division.hpp"

#include <gtest/gtest.h>

#include <random>

#include "large/blocks.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kGroundSpacing = 1e-3;  // m: of the ground

/// 90 000 points of a flat square, off their places by a tenth of a spacing.
PointCloud ground() {
  std::mt19937 random(5);
  std::normal_distribution<double> error(0, 0.1);
  PointCloud cloud;
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < 300; ++j) {
      const Vector3d at(i + error(random), j + error(random), error(random));
      cloud.positions.push_back((kGroundSpacing * at).cast<float>());
    }
  }
  return cloud;
}

/// Outliers anywhere up to `high` above the ground.
PointCloud with_outliers(PointCloud cloud, int count, double high) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < count; ++i) {
    const Vector3d at(0.3 * share(random), 0.3 * share(random), high * share(random));
    cloud.positions.push_back(at.cast<float>());
  }
  return cloud;
}

/// Points that all blocks are prepared with.
std::size_t work(const PointCloud& cloud) {
  PrepareOptions options;
  options.facts = measure_facts(cloud, options);
  const Placed placed = place(cloud, options, Eigen::Isometry3d::Identity());
  const Blocks blocks(placed, options);
  const Division division(cloud, *options.facts);
  std::size_t points = 0;
  for (std::size_t k = 0; k < division.size(); ++k) {
    points += division.around(k, blocks.halo(k)).size();
  }
  return points;
}

TEST(Division, EachPointBelongsToOneBlock) {
  const PointCloud cloud = with_outliers(ground(), 300, 0.5);
  const Division division(cloud, measure_facts(cloud, {}));
  std::size_t points = 0;
  for (std::size_t k = 0; k < division.size(); ++k) points += division.points(k);
  EXPECT_EQ(points, cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    int owners = 0;
    for (std::size_t k = 0; k < division.size(); ++k) {
      if (!division.owns(k, cloud.point(i))) continue;
      ++owners;
      EXPECT_TRUE(division.box(k).contains(cloud.point(i)));
    }
    EXPECT_EQ(owners, 1) << i;
  }
}

TEST(Division, BlocksOfAnEvenSheetAreOfOneSize) {
  const PointCloud cloud = ground();
  CloudFacts facts = measure_facts(cloud, {});
  const double measured = facts.radius;
  for (int i = 0; i < 20; ++i) {  // whatever its last digits
    facts.radius = measured * (1 + 0.01 * i);
    const Division division(cloud, facts);
    EXPECT_GT(division.size(), 1u);
    for (std::size_t k = 0; k < division.size(); ++k) {
      EXPECT_EQ(division.radius(k), facts.radius);
    }
  }
}

TEST(Division, OutliersOverDenseGroundCostLittle) {
  const auto plain = static_cast<double>(work(ground()));
  for (const double high : {0.02, 0.1, 0.3, 1., 10.}) {
    for (const int count : {5, 50, 500}) {
      const auto more = static_cast<double>(work(with_outliers(ground(), count, high)));
      EXPECT_LT(more, 1.05 * plain) << count << " up to " << high << " m";
    }
  }
}

}  // namespace
}  // namespace palpate
