// What of a store cannot be read or prepared is refused, or missing, and the rest is felt.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "large/paged_store.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

/// Says that it has more points than any block may have.
class VastStore final : public PointStore {
 public:
  VastStore() {
    layout_.edge = 1;
    layout_.points = std::size_t{1} << 30U;
    layout_.nodes = {{0, {0, 0, 0}, layout_.points}};
  }
  [[nodiscard]] const Layout& layout() const override { return layout_; }
  [[nodiscard]] PointCloud read(std::size_t) const override {
    PointCloud cloud;
    cloud.positions = {{0.5F, 0.5F, 0.5F}};
    return cloud;
  }

 private:
  Layout layout_;
};

TEST(StoreLimits, ABlockThatWouldTakeAllMemoryIsRefused) {
  SourceOptions options;
  options.prepare.facts = CloudFacts{};
  options.prepare.facts->radius = 1;
  options.prepare.facts->extent = {{0, 0, 0}, {1, 1, 1}};
  OnDemand demand(std::make_shared<VastStore>(), options.prepare, options.T_world_sensor, kRoom);
  Scene scene;
  Source& source = scene.add("vast", options);
  try {
    demand.advance(source, 0);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("give a smaller radius"), std::string::npos);
  }
}

TEST(StoreLimits, ARadiusFarBeyondTheSpacingIsRefusedBeforeAnyBlockIsRead) {
  const auto store = std::make_shared<MadeStore>(even());
  PrepareOptions options;
  const auto open = [&] { OnDemand(store, options, Eigen::Isometry3d::Identity(), kRoom); };
  options.radius = 0.015;  // of a spacing of 0.002
  EXPECT_NO_THROW(open());
  options.radius = 0.5;
  try {
    open();
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("an R of 0.5 m is too large"));
    EXPECT_THAT(error.what(), testing::HasSubstr("or a voxel of at least 0.05 m"));
  }
  options.voxel = 0.05;
  EXPECT_NO_THROW(open());
}

TEST(StoreLimits, WhatNeedsAllOfItIsRefused) {
  const auto store = std::make_shared<MadeStore>(even());
  PrepareOptions options;
  options.paper = true;
  EXPECT_THROW(OnDemand(store, options, Eigen::Isometry3d::Identity(), kRoom), Error);
}

/// Presses there and says whether the place is told as missing.
bool is_missing(Paged& paged, const Vector3d& place) {
  EXPECT_FALSE(paged.press(*paged.field, place).touching);
  return has(paged.field->notes(), FieldNote::not_loaded);
}

/// Moves a hand there and collects what is told.
std::vector<std::string> told_at(Paged& paged, const Vector3d& place) {
  std::vector<std::string> told;
  for (bool more = true; more;) {
    try {
      paged.field->update_from(paged.time += 1e-3, place, place);
      more = paged.demand->advance(*paged.source, paged.time);
    } catch (const Error& error) {
      told.emplace_back(error.what());
    }
  }
  for (int k = 0; k < 200; ++k)
    paged.field->update_from(paged.time += 1e-3, place, place);  // it rises
  return told;
}

TEST(StoreLimits, ADamagedNodeIsToldOnceItsPlaceIsMissingAndTheRestGoesOn) {
  Paged paged(even());
  const Vector3d broken(100.05, 200.05, hill_height(0.05, 0.05));
  const PointStore::Layout& layout = paged.store->layout();
  paged.store->on_read = [&](std::size_t node) {
    if (layout.nodes[node].level > 1 && layout.box(node).contains(broken)) {
      throw Error("a.copc.laz, byte 77: node 2-0-0-0 ends inside its point 3 of 9");
    }
  };
  EXPECT_THAT(told_at(paged, broken), testing::ElementsAre(testing::HasSubstr("node 2-0-0-0")));
  EXPECT_TRUE(is_missing(paged, broken));
  EXPECT_LT(paged.demand->share(), 1);
  EXPECT_THAT(told_at(paged, broken + Vector3d(1e-3, 0, 0)), testing::IsEmpty());
  const Vector3d sound(100.9, 200.9, hill_height(0.9, 0.9));
  EXPECT_THAT(told_at(paged, sound), testing::IsEmpty());
  SceneField all(paged.whole);
  const Contact expected = paged.press(all, sound);
  EXPECT_TRUE(expected.touching);
  EXPECT_EQ(paged.press(*paged.field, sound).force, expected.force);
}

TEST(StoreLimits, ANodeThatCanBeReadAgainIsFeltAfterTenSeconds) {
  Paged paged(even());
  const Vector3d place(100.05, 200.05, hill_height(0.05, 0.05));
  paged.store->on_read = [](std::size_t) { throw Error("the network is gone"); };
  EXPECT_EQ(told_at(paged, place).size(), 1u);
  EXPECT_TRUE(is_missing(paged, place));
  paged.store->on_read = {};
  EXPECT_THAT(told_at(paged, place), testing::IsEmpty());
  EXPECT_TRUE(is_missing(paged, place)) << "it is not tried all the time";
  paged.time += 10;
  paged.go(place);
  EXPECT_TRUE(paged.press(*paged.field, place).touching);
}

TEST(StoreLimits, AStoreOfWhichNothingCanBeReadIsRefused) {
  const auto store = std::make_shared<MadeStore>(even());
  store->on_read = [](std::size_t) { throw Error("the disk is gone"); };
  EXPECT_THROW(OnDemand(store, {}, Eigen::Isometry3d::Identity(), kRoom), Error);
}

}  // namespace
}  // namespace palpate
