// Checks who is who: which old points the blocks of a new frame show again.
#include "stream/block_matches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "stream/morph.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::kFrame;
using test::looking_down;
using test::small_camera;
using test::wall;

// Shows a wall in every block, then looks at another frame.
class BlockMatchesTest : public testing::Test {
 protected:
  BlockMatchesTest() {
    Morph morph{{}};
    const FilteredDepth depth = filtered(wall(0.5));
    auto points = std::make_shared<SurfacePoints>();
    morph.look({depth, pinhole_});
    morph.fill_still({depth, pinhole_}, {0, 0, kFrame}, points);
    std::vector<Entry> entries(points->size());
    for (std::uint32_t i = 0; i < entries.size(); ++i) entries[i].index = i;
    origin_ = points->origin;
    shown_.replace(std::move(points), {0, 0, kFrame}, entries);
    show(wall(0.5), false);
  }

  FilteredDepth filtered(const test::DepthOf& depth_of) {
    DepthFilter filter({.memory = 1});
    return filter.filter(test::frame_of(small_camera(), 0, depth_of), T_world_sensor_);
  }

  void show(const test::DepthOf& depth_of, bool moved, double duration = kFrame) {
    depth_ = filtered(depth_of);
    blocks_.look(depth_, {}, true);
    shown_.begin({kFrame, kFrame, kFrame}, origin_);
    blocks_.put(depth_, origin_, false);
    matches_.begin(moved, pinhole_, duration);
  }

  [[nodiscard]] SeenPoint seen(std::uint32_t index) const { return blocks_.four_at(index).lane(0); }
  [[nodiscard]] std::size_t middle() const { return blocks_.order().indices[depth_.size() / 2]; }

  Pinhole pinhole_ = small_camera().pinhole;
  Eigen::Isometry3d T_world_sensor_ = looking_down();
  Vector3d origin_ = Vector3d::Zero();
  FilteredDepth depth_;
  FrameBlocks blocks_{Kernel::wyvill, 0};
  ShownPoints shown_;
  BlockMatches matches_{shown_, blocks_};
};

TEST_F(BlockMatchesTest, ABlockThatShowsThePointAgainIsItsPartner) {
  for (std::uint32_t index = 0; index < blocks_.order().size(); ++index) {
    const auto partner = matches_.partner_of(seen(index));
    ASSERT_TRUE(partner) << index;
    EXPECT_EQ(partner->i, index);
    EXPECT_EQ(partner->before.position, seen(index).state.position);
  }
  EXPECT_EQ(matches_.four_at(4), 4u);
}

TEST_F(BlockMatchesTest, WhatHasMovedAsFastAsAHandIsTheSame) {
  show(wall(0.5 - 0.9 * kFrame), false);
  EXPECT_TRUE(matches_.partner_of(seen(middle())));
}

TEST_F(BlockMatchesTest, WhatHasMovedFasterIsAnother) {
  show(wall(0.4), false);
  EXPECT_FALSE(matches_.partner_of(seen(middle())));
}

// An arm that came over a table while frames were lost took the table along, and a hand on it.
TEST_F(BlockMatchesTest, WhatIsFarNearerAfterALongGapIsAnother) {
  show(wall(0.5 - 0.056), false, 4 * kFrame);
  EXPECT_FALSE(matches_.partner_of(seen(middle())));
  show(wall(0.5 - 0.9 * kFrame), false, 4 * kFrame);
  EXPECT_TRUE(matches_.partner_of(seen(middle())));
}

TEST_F(BlockMatchesTest, WhatLeavesIsNoPartner) {
  shown_.entries()[middle()].kind = EntryKind::removed;
  EXPECT_FALSE(matches_.partner_of(seen(middle())));
}

TEST_F(BlockMatchesTest, AMovingCameraFindsPointsAtTheBlocksThatSeeThemNow) {
  T_world_sensor_.translation() += Vector3d(0.01, 0, 0);
  show(wall(0.5), true);
  std::size_t matched = 0;
  std::size_t outside = 0;
  for (std::uint32_t i = 0; i < shown_.entries().size(); ++i) {
    const Entry& entry = shown_.entries()[i];
    if (entry.kind == EntryKind::out_of_range) {
      ++outside;
      continue;
    }
    const auto partner = matches_.partner_of(seen(entry.index));
    ASSERT_TRUE(partner) << i;
    EXPECT_LT((partner->before.position - shown_.at(i).position).norm(), seen(i).state.radius);
    ++matched;
  }
  EXPECT_GT(outside, 0u);
  EXPECT_GT(matched, 5 * outside);
}

TEST_F(BlockMatchesTest, WhatWasListedBeforeTheFrameIsWhereItIs) {
  std::vector<Entry> turned(shown_.entries().rbegin(), shown_.entries().rend());
  const auto all_at = [&](std::size_t shift) {
    bool all = true;
    for (std::uint32_t i = 0; i < turned.size(); ++i) {
      const auto there = matches_.at((turned[i].index + shift) % turned.size());
      all = all && there.size() == 1 && there[0] == i;
    }
    return all;
  };
  matches_.end(turned);
  EXPECT_TRUE(all_at(0));
  shown_.entries() = turned;
  show(wall(0.5), false);
  EXPECT_TRUE(all_at(0));

  // Nothing is listed twice: what changes afterwards is told.
  for (Entry& entry : shown_.entries()) entry.index = (entry.index + 1) % turned.size();
  show(wall(0.5), false);
  EXPECT_TRUE(all_at(1));
  matches_.end(turned);
  matches_.forget();
  show(wall(0.5), false);
  EXPECT_TRUE(all_at(1));
}

TEST_F(BlockMatchesTest, NothingIsListedBeforehandForACameraThatMoves) {
  T_world_sensor_.translation() += Vector3d(0.01, 0, 0);
  show(wall(0.5), true);
  const std::vector<Entry> none;
  matches_.end(none);
  EXPECT_FALSE(matches_.at(shown_.entries()[middle()].index).empty());
}

TEST_F(BlockMatchesTest, APointThatComesBackIntoTheImageIsLiveAgain) {
  T_world_sensor_.translation() += Vector3d(0.01, 0, 0);
  show(wall(0.5), true);
  const auto is_outside = [](const Entry& entry) { return entry.kind == EntryKind::out_of_range; };
  EXPECT_TRUE(std::ranges::any_of(shown_.entries(), is_outside));
  T_world_sensor_ = looking_down();
  show(wall(0.5), true);
  for (const Entry& entry : shown_.entries()) EXPECT_EQ(entry.kind, EntryKind::live);
}

}  // namespace
}  // namespace palpate
