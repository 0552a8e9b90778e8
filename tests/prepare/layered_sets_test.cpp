// Points that lie over each other do not become one sheet through an edge.
#include "prepare/layered_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/clouds.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

TEST(LayeredSets, AreJoinedOnceMorePairsAskThanLieOverEachOther) {
  detail::SignedSets sets(6);
  LayeredSets layered(sets);
  layered.add_layers(0, 3, 1);
  layered.add_layers(1, 4, 1);
  layered.join(0, 1, 1);
  layered.join(3, 4, 1);
  layered.join(2, 5, 1);  // lie over nothing
  layered.join(1, 2, 1);
  EXPECT_EQ(sets.find(5), std::pair(0u, 1));
  for (const std::uint32_t i : {0u, 5u}) {
    layered.join(i, 3, 1);
    EXPECT_EQ(sets.find(3), std::pair(3u, 1));
  }
  layered.join(5, 4, 1);
  EXPECT_EQ(sets.find(3), std::pair(0u, 1));
}

TEST(LayeredSets, MayFaceEachOther) {
  detail::SignedSets sets(4);
  LayeredSets layered(sets);
  layered.add_layers(0, 2, 1);
  layered.add_layers(1, 2, -1);
  layered.join(0, 1, -1);  // so both say the same of 2
  layered.join(2, 3, -1);
  layered.join(0, 3, -1);  // as 0 and 2 alike
  EXPECT_EQ(sets.find(3), std::pair(2u, -1));
  layered.join(0, 3, 1);
  EXPECT_EQ(sets.find(3), std::pair(0u, 1));
  EXPECT_EQ(sets.find(2), std::pair(0u, -1));
}

TEST(LayeredSets, AreTheSidesOfABladeWhoseEdgeIsThinnerThanItsPointsAreApart) {
  constexpr double kLength = 60;
  for (const double thickness : {2.5, 4.0, 6.0}) {
    test::Clouds clouds(7);
    PointCloud cloud;
    for (int k = 0; k < 6000; ++k) {
      const double x = clouds.uniform(0, kLength);
      const double half = thickness / 2 * (1 - x / kLength);
      const double y = clouds.uniform(0, 50);
      cloud.positions.push_back(Eigen::Vector3d(x, y, k % 2 == 0 ? half : -half).cast<float>());
    }
    const SurfacePoints points = prepare(cloud).points;
    int outward = 0;
    int all = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float z = points.grid.points()[i].z();
      if (std::abs(z) < 0.75f) continue;  // thinner than 1.5 spacings
      ++all;
      if (z * points.normals[i].z() > 0) ++outward;
    }
    EXPECT_GT(all, 1000);
    EXPECT_GT(outward, 0.99 * all) << thickness;
  }
}

}  // namespace
}  // namespace palpate
