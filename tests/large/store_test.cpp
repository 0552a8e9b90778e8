// A store of points is felt as the cloud that it holds, whatever little of it is in memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "large/paged_store.hpp"

namespace palpate {
namespace {

TEST(Store, IsFeltAsTheWholeOfItsPoints) {
  Paged paged(even());
  paged.expect_whole(1);
}

TEST(Store, IsFeltAsTheWholeWherePointsAreMuchSparser) {
  PointCloud cloud = hill_cloud(
      [](double x, double y) { return std::hypot(x - 0.5, y - 0.5) < 0.25 ? 1. / 500 : 1. / 25; });
  for (const double z : {0.2, 0.4, -0.3}) {
    cloud.positions.push_back(Vector3d(0.3, 0.7, z).cast<float>());  // outliers
  }
  Paged paged(std::move(cloud));
  paged.expect_whole(2);
}

TEST(Store, IsFeltAsTheWholeWhereverItIsPut) {
  SourceOptions options;
  options.T_world_sensor = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  options.T_world_sensor.pretranslate(Vector3d(5, -3, 2));
  options.prepare.clip = Box{{100.01, 200, -1}, {100.99, 201, 1}};
  Paged paged(even(), kRoom, options);
  paged.expect_whole(3);
}

TEST(Store, WithLittleMemoryItIsReadMoreOften) {
  Paged enough(even());
  Paged little(even(), std::size_t{2} << 20U);
  enough.expect_whole(4);
  little.expect_whole(4);
  EXPECT_EQ(little.demand->share(), 1);  // of what there is memory for
  EXPECT_GT(little.store->reads(), enough.store->reads());
}

TEST(Store, WhatIsNotReadYetIsFreeAndSaysSo) {
  Paged paged(even());
  const Vector3d far(100.05, 200.05, hill_height(0.05, 0.05));
  EXPECT_FALSE(paged.press(*paged.field, far).touching);
  EXPECT_TRUE(has(paged.field->notes(), FieldNote::not_loaded));
}

TEST(Store, AllOfItIsSeenThinned) {
  SourceOptions options;
  options.T_world_sensor.translation() = Vector3d(0, 0, 7);
  Paged paged(even(), kRoom, options);
  const auto overview = paged.source->state().overview;
  ASSERT_TRUE(overview);
  EXPECT_GT(overview->size(), 20'000u);
  Box box;
  for (std::size_t i = 0; i < overview->size(); ++i) box.extend(overview->point(i));
  EXPECT_LT((box.lower - Vector3d(100, 200, 6.97)).norm(), 0.01);
  EXPECT_LT((box.upper - Vector3d(101, 201, 7.03)).norm(), 0.01);
}

TEST(Store, NothingIsDoneWhileAHandRests) {
  Paged paged(even());
  const Vector3d place(100.5, 200.5, hill_height(0.5, 0.5));
  paged.go(place);
  const std::size_t reads = paged.store->reads();
  const auto points = paged.source->points();
  paged.go(place);
  EXPECT_EQ(paged.store->reads(), reads);
  EXPECT_EQ(paged.source->points(), points);
  EXPECT_FALSE(paged.demand->done());
  EXPECT_EQ(paged.demand->share(), 1);
}

/// A hand in free air far above everything, where no block has a point.
TEST(Store, FarFromAllPointsThereIsNothingToFeel) {
  Paged paged(even());
  const Vector3d place(100.5, 200.5, 0.8);
  paged.go(place);
  EXPECT_EQ(paged.press(*paged.field, place).force, Vector3d::Zero());
  EXPECT_FALSE(has(paged.field->notes(), FieldNote::not_loaded));
  paged.go({100.5, 200.5, hill_height(0.5, 0.5)});
  EXPECT_TRUE(paged.press(*paged.field, {100.5, 200.5, hill_height(0.5, 0.5)}).touching);
}

/// In the cube of the surface, but farther from its points than what is prepared around a tool.
TEST(Store, InTheAirHighAboveASurfaceAllIsKnown) {
  Paged paged(even());
  paged.go({100.3, 200.3, 0.14});
  paged.field->update_from(paged.time += 1e-3, {100.3, 200.3, 0.14}, {100.3, 200.3, 0.14});
  EXPECT_FALSE(has(paged.field->notes(), FieldNote::not_loaded));
}

TEST(Store, ABlockUnderAHandIsKeptHoweverLittleMemoryThereIs) {
  Paged paged(even(), 1);
  const Vector3d place(100.3, 200.3, 0.14);
  std::size_t steps = 0;
  for (int k = 0; k < 100; ++k) {
    paged.field->update_from(paged.time += 1e-3, place, place);
    steps += paged.demand->advance(*paged.source, paged.time, false) ? 1 : 0;
  }
  EXPECT_LT(steps, 20u);
  EXPECT_FALSE(has(paged.field->notes(), FieldNote::not_loaded));
}

TEST(Store, ASurfaceThatArrivesUnderAHandPushesNobody) {
  Paged paged(even());
  const Vector3d hip(100.05, 200.05, hill_height(0.05, 0.05) - 3e-3);
  Proxy proxy;
  proxy.reset(hip);
  double largest = 0;
  bool came = false;
  for (int k = 0; k < 2000; ++k) {
    paged.field->update(paged.time += 1e-3, hip, proxy);
    largest = std::max(largest, proxy.step(*paged.field, hip, 1e-3).force.norm());
    came = came || !has(paged.field->notes(), FieldNote::not_loaded);
    if (k % 20 == 0) paged.demand->advance(*paged.source, paged.time);
  }
  EXPECT_TRUE(came);
  EXPECT_LT(largest, 0.05);  // N
}

/// A run begins with another source than the one that was shown the first blocks, and with a hand.
TEST(Store, WhatIsFirstShownToAHandRises) {
  Paged paged(even());
  Scene scene;
  Source& source = scene.add("run", paged.options);
  SceneField field(scene);
  const Vector3d hip(100.05, 200.05, hill_height(0.05, 0.05) - 3e-3);
  field.update_from(paged.time, hip, hip);
  while (!source.points()) paged.demand->advance(source, paged.time);
  const std::vector<float>& presences = source.points()->presences;
  EXPECT_EQ(std::ranges::min(presences), 0) << "what is around the hand";
  EXPECT_EQ(std::ranges::max(presences), 1) << "what was shown before";
}

}  // namespace
}  // namespace palpate
