// prepare() tells how far it is, and what is thrown then ends it: at once and by blocks.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "palpate/io/synthetic.hpp"
#include "palpate/prepare/cloud_facts.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

struct Enough {};

// Options that prepare a cloud at once, and by several blocks.
std::vector<PrepareOptions> both_ways(const PointCloud& cloud) {
  PrepareOptions by_blocks;
  by_blocks.facts = measure_facts(cloud, {});
  by_blocks.facts->radius /= 4;
  return {{}, by_blocks};
}

TEST(PrepareProgress, RisesAndChangesNothing) {
  const PointCloud cloud = synthetic_cloud("torus", {.spacing = 1e-3});
  for (PrepareOptions& options : both_ways(cloud)) {
    const SurfacePoints alone = prepare(cloud, options).points;
    std::vector<double> shares;
    options.progress = [&](double share) { shares.push_back(share); };
    const SurfacePoints told = prepare(cloud, options).points;
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    ASSERT_GE(shares.size(), 5u);
    EXPECT_GE(shares.front(), 0);
    EXPECT_LE(shares.back(), 1);
    EXPECT_GT(shares.back(), 0.7);
    EXPECT_TRUE(std::ranges::equal(alone.grid.points(), told.grid.points()));
    EXPECT_EQ(alone.normals, told.normals);
    EXPECT_EQ(alone.radii, told.radii);
  }
}

TEST(PrepareProgress, WhatItThrowsEndsThePreparation) {
  const PointCloud cloud = synthetic_cloud("torus", {.spacing = 2e-3});
  for (PrepareOptions& options : both_ways(cloud)) {
    int calls = 0;
    options.progress = [&](double) { ++calls; };
    const SurfacePoints whole = prepare(cloud, options).points;
    const int all = calls;
    for (int last = 1; last < all; last += std::max(1, all / 5)) {
      calls = 0;
      options.progress = [&](double) {
        if (++calls == last) throw Enough();
      };
      EXPECT_THROW((void)prepare(cloud, options), Enough) << last << " of " << all;
      EXPECT_EQ(calls, last) << "nobody is told of what has ended";
    }
    options.progress = {};
    EXPECT_EQ(prepare(cloud, options).points.normals, whole.normals);
  }
}

}  // namespace
}  // namespace palpate
