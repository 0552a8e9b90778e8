// Points that lie over each other do not become one segment through an edge.
#include "refine/cannot_link_sets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "geometry/clouds.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

TEST(CannotLinkSets, AreJoinedOnceMorePairsAskThanLieOverEachOther) {
  detail::SignedSets sets(6);
  CannotLinkSets constrained(sets, 6);
  constrained.add_cannot_link(0, 3, 1);
  constrained.add_cannot_link(1, 4, 1);
  constrained.join(0, 1, 1);
  constrained.join(3, 4, 1);
  constrained.join(2, 5, 1);  // lie over nothing
  constrained.join(1, 2, 1);
  EXPECT_EQ(sets.find(5), std::pair(0u, 1));
  for (const std::uint32_t i : {0u, 5u}) {
    constrained.join(i, 3, 1);
    EXPECT_EQ(sets.find(3), std::pair(3u, 1));
  }
  constrained.join(5, 4, 1);
  EXPECT_EQ(sets.find(3), std::pair(0u, 1));
}

TEST(CannotLinkSets, MayFaceEachOther) {
  detail::SignedSets sets(4);
  CannotLinkSets constrained(sets, 4);
  constrained.add_cannot_link(0, 2, 1);
  constrained.add_cannot_link(1, 2, -1);
  constrained.join(0, 1, -1);  // so both say the same of 2
  constrained.join(2, 3, -1);
  constrained.join(0, 3, -1);  // as 0 and 2 alike
  EXPECT_EQ(sets.find(3), std::pair(2u, -1));
  constrained.join(0, 3, 1);
  EXPECT_EQ(sets.find(3), std::pair(0u, 1));
  EXPECT_EQ(sets.find(2), std::pair(0u, -1));
}

/// The same by the rule alone: all pairs of points are counted again for each join.
class CountedAgain {
 public:
  struct Pair {
    std::uint32_t i, j;
    int sign;
  };

  explicit CountedAgain(std::size_t count) : sets_(count) {}

  void add_cannot_link(const Pair& pair) { layers_.push_back(pair); }
  void join(const Pair& pair) {
    if (sets_.find(pair.i).first == sets_.find(pair.j).first) return;
    asked_.push_back(pair);
    if (like(layers_, pair) < like(asked_, pair)) sets_.join(pair.i, pair.j, pair.sign);
  }
  [[nodiscard]] std::pair<std::uint32_t, int> find(std::uint32_t i) { return sets_.find(i); }

 private:
  /// How many pairs are between the sets of this one and speak of the same sign.
  int like(const std::vector<Pair>& pairs, const Pair& pair) {
    const auto [root_i, sign_i] = sets_.find(pair.i);
    const auto [root_j, sign_j] = sets_.find(pair.j);
    int count = 0;
    for (const Pair& other : pairs) {
      const auto [root_a, sign_a] = sets_.find(other.i);
      const auto [root_b, sign_b] = sets_.find(other.j);
      const bool same =
          (root_a == root_i && root_b == root_j) || (root_a == root_j && root_b == root_i);
      if (same && other.sign * sign_a * sign_b == pair.sign * sign_i * sign_j) ++count;
    }
    return count;
  }

  detail::SignedSets sets_;
  std::vector<Pair> layers_;
  std::vector<Pair> asked_;
};

TEST(CannotLinkSets, AreThoseThatCountingAgainFinds) {
  constexpr std::uint32_t kPoints = 14;
  std::mt19937 random(3);
  const auto draw = [&] {
    const auto i = static_cast<std::uint32_t>(random() % kPoints);
    const auto j = static_cast<std::uint32_t>(random() % kPoints);
    return CountedAgain::Pair{i, j, random() % 2 == 0 ? 1 : -1};
  };
  for (int run = 0; run < 2000; ++run) {
    detail::SignedSets sets(kPoints);
    CannotLinkSets constrained(sets, kPoints);
    CountedAgain expected(kPoints);
    for (std::size_t layers = random() % 40; layers > 0; --layers) {
      const CountedAgain::Pair pair = draw();
      if (pair.i == pair.j) continue;
      constrained.add_cannot_link(pair.i, pair.j, pair.sign);
      expected.add_cannot_link(pair);
    }
    for (int joins = 0; joins < 60; ++joins) {
      const CountedAgain::Pair pair = draw();
      constrained.join(pair.i, pair.j, pair.sign);
      expected.join(pair);
      for (std::uint32_t i = 0; i < kPoints; ++i) ASSERT_EQ(sets.find(i), expected.find(i)) << run;
    }
  }
}

TEST(CannotLinkSets, AreTheSidesOfABladeWhoseEdgeIsThinnerThanItsPointsAreApart) {
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
