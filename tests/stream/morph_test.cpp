// Checks what becomes of the points of simple scenes from frame to frame.
#include "stream/morph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/geometry/spacing.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using test::kFrame;

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::frame_of;
using test::looking_down;
using test::small_camera;
using test::wall;

// Feeds frames of a small camera that looks down at z = 0 and keeps what comes out.
class MorphTest : public testing::Test {
 protected:
  const SurfacePoints& show(double stamp, const test::DepthOf& depth_of) {
    const DepthFrame frame = frame_of(small_camera(), stamp, depth_of);
    DepthFilter filter({.memory = 1});
    const FilteredDepth& depth = filter.filter(frame, T_world_sensor_);
    points_ = std::make_shared<SurfacePoints>();
    morph_.look({depth, frame.camera.pinhole});
    morph_.fill({depth, frame.camera.pinhole}, {stamp, stamp + lead_, kFrame}, points_);
    check(*points_);
    return *points_;
  }

  [[nodiscard]] Vector3d start(std::size_t i) const {
    return points_->origin + points_->grid.points()[i].cast<double>();
  }
  [[nodiscard]] Vector3d end(std::size_t i) const {
    return points_->origin + points_->end_positions[i].cast<double>();
  }
  // Points whose weight goes from something to nothing, from nothing to something, or stays.
  [[nodiscard]] std::size_t leaving() const {
    return count([](float a, float b) { return a > 0 && b == 0; });
  }
  [[nodiscard]] std::size_t coming() const {
    return count([](float a, float b) { return a == 0 && b > 0; });
  }
  [[nodiscard]] std::size_t staying() const {
    return count([](float a, float b) { return a > 0 && b > 0; });
  }

  Morph morph_{{}};
  Eigen::Isometry3d T_world_sensor_ = looking_down();
  double lead_ = 0.01;
  std::shared_ptr<SurfacePoints> points_;

 private:
  template <class Is>
  [[nodiscard]] std::size_t count(const Is& is) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < points_->size(); ++i) {
      n += is(points_->density_weights[i], points_->end_density_weights[i]) ? 1 : 0;
    }
    return n;
  }
};

TEST_F(MorphTest, WhatWasNotThereFadesIn) {
  show(0, wall(0.5));
  EXPECT_EQ(coming(), points_->size());
  EXPECT_GT(points_->size(), 4500u);
}

TEST_F(MorphTest, EveryBlockGoesToItsNewPlace) {
  show(0, wall(0.5));
  show(kFrame, wall(0.497));
  EXPECT_EQ(staying(), points_->size());
  for (std::size_t i = 0; i < points_->size(); i += 7) {
    EXPECT_NEAR(start(i).z(), 0, 1e-6);
    EXPECT_NEAR(end(i).z(), 3e-3, 1e-6);
  }
}

TEST_F(MorphTest, AnEarlyFrameStartsFromHalfWay) {
  show(0, wall(0.5));
  show(kFrame, wall(0.497));
  show(1.5 * kFrame, wall(0.497));
  EXPECT_GT(points_->size(), 4500u);
  for (std::size_t i = 0; i < points_->size(); i += 7) {
    EXPECT_NEAR(start(i).z(), 1.5e-3, 1e-6);
    EXPECT_NEAR(end(i).z(), 3e-3, 1e-6);
  }
}

TEST_F(MorphTest, ALateFrameStartsFromWhereTheSurfaceWaits) {
  show(0, wall(0.5));
  show(kFrame, wall(0.497));
  show(5 * kFrame, wall(0.495));
  EXPECT_GT(points_->size(), 4500u);
  for (std::size_t i = 0; i < points_->size(); i += 7) EXPECT_NEAR(start(i).z(), 3e-3, 1e-6);
}

test::DepthOf with_hole(double z, double hole_z) {
  return [=](double x, double y) { return std::hypot(x, y) < 0.03 ? hole_z : z; };
}

TEST_F(MorphTest, WhatComesBetweenHidesAndAppearsSlowly) {
  show(0, wall(0.5));
  show(kFrame, wall(0.5));
  const std::size_t count = points_->size();
  for (int k = 2; k < 20; ++k) {
    show(k * kFrame, wall(0.4));
    ASSERT_EQ(points_->size(), 2 * count);
    for (std::size_t i = 0; i < points_->size(); i += 7) {
      EXPECT_EQ(start(i), end(i));
      const bool hidden = end(i).z() < 0.05;
      const double sure =
          hidden ? 1 - (k - 1) * kFrame / 60 : std::min(1.0, (k - 1) * kFrame / 0.5);
      EXPECT_NEAR(points_->end_presences[i], sure, 1e-4) << k;
    }
  }
  show(20 * kFrame, wall(0.5));
  EXPECT_EQ(points_->size(), 2 * count) << "it was there all the time, and the other one goes";
  EXPECT_EQ(coming(), 0u);
}

TEST_F(MorphTest, WhatIsSeenThroughGoesByItsPresence) {
  show(0, with_hole(0.5, 0.4));
  show(kFrame, with_hole(0.5, 0.4));
  show(2 * kFrame, wall(0.5));
  const std::size_t count = 4800;
  EXPECT_GT(points_->size(), count + 40);
  for (int k = 1; k <= 2; ++k) {
    for (std::size_t i = 0; i < points_->size(); ++i) {
      if (end(i).z() < 0.05) continue;
      EXPECT_NEAR(points_->end_presences[i], 1 - k * kFrame / 0.1, 1e-5);
    }
    EXPECT_EQ(leaving(), 0u) << "its weight goes when nobody feels it any more";
    show((2 + k) * kFrame, wall(0.5));
  }
  for (int k = 5; k < 8; ++k) show(k * kFrame, wall(0.5));
  EXPECT_EQ(points_->size(), count);
}

TEST_F(MorphTest, WhatMovesAsFastAsAHandMovesAndIsNotAnother) {
  show(0, wall(0.5));
  double z = 0.5;
  for (int k = 1; k < 6; ++k) {
    z -= 0.9 * kFrame;
    show(k * kFrame, wall(z));
    EXPECT_EQ(staying(), points_->size());
  }
  EXPECT_NEAR(end(points_->size() / 2).z(), 0.5 - z, 1e-6);
}

TEST_F(MorphTest, AHoleKeepsItsPointsUntilTheyHaveFaded) {
  show(0, wall(0.5));
  const std::size_t count = points_->size();
  int k = 1;
  for (; k * kFrame < 0.25; ++k) {
    show(k * kFrame, with_hole(0.5, 0));
    ASSERT_EQ(points_->size(), count);
    EXPECT_TRUE(points_->presences.empty()) << "no doubt so soon";
  }
  float last = 1;
  for (; k * kFrame < 0.75; ++k) {
    show(k * kFrame, with_hole(0.5, 0));
    ASSERT_EQ(points_->size(), count);
    if (points_->presences.empty()) continue;
    const float lowest =
        *std::min_element(points_->end_presences.begin(), points_->end_presences.end());
    EXPECT_LE(last - lowest, 1.01 * kFrame / 0.5) << "presence falls by 1 in half a second";
    last = lowest;
  }
  EXPECT_LT(last, 0.2f);
  for (; k * kFrame < 0.95; ++k) show(k * kFrame, with_hole(0.5, 0));
  EXPECT_LT(points_->size(), count - 40);
}

TEST_F(MorphTest, AHoleIsForgottenAsSoonWhenStampsGoBack) {
  for (const double stamp : {100.0, 100 + kFrame}) show(stamp, wall(0.5));
  const std::size_t count = points_->size();
  for (int k = 0; k * kFrame < 1; ++k) show(k * kFrame, with_hole(0.5, 0));
  EXPECT_LT(points_->size(), count - 40);
}

TEST_F(MorphTest, APointThatIsSeenAgainBecomesSureAgain) {
  show(0, wall(0.5));
  int k = 1;
  for (; k * kFrame < 0.6; ++k) show(k * kFrame, with_hole(0.5, 0));
  const float low = *std::min_element(points_->end_presences.begin(), points_->end_presences.end());
  EXPECT_LT(low, 0.6f);
  show(k * kFrame, wall(0.5));
  EXPECT_EQ(coming(), 0u);
  EXPECT_NEAR(*std::min_element(points_->presences.begin(), points_->presences.end()), low, 1e-6);
  EXPECT_NEAR(*std::min_element(points_->end_presences.begin(), points_->end_presences.end()),
              low + kFrame / 0.5, 1e-5);
}

TEST_F(MorphTest, AMovingCameraKeepsThePointsOfAStillWall) {
  show(0, wall(0.5));
  const std::size_t count = points_->size();
  for (int k = 1; k < 10; ++k) {
    T_world_sensor_.pretranslate(Vector3d(1.7e-3, 0.4e-3, 0));
    T_world_sensor_.rotate(Eigen::AngleAxisd(3e-3, Vector3d::UnitZ()));
    show(k * kFrame, wall(0.5));
    EXPECT_GT(staying(), 9 * count / 10);
    double way = 0;
    for (std::size_t i = 0; i < points_->size(); ++i) {
      way = std::max(way, (end(i) - start(i)).norm());
      EXPECT_NEAR(end(i).z(), 0, 2e-5);
    }
    EXPECT_LT(way, 2.2e-3) << "half a block's diagonal";
  }
}

TEST_F(MorphTest, WhatAMovingCameraLeavesBehindIsHeldForAWhile) {
  show(0, wall(0.5));
  T_world_sensor_.pretranslate(Vector3d(0.05, 0, 0));
  show(kFrame, wall(0.5));
  std::size_t behind = 0;
  for (std::size_t i = 0; i < points_->size(); ++i) behind += end(i).x() < -0.06 ? 1 : 0;
  EXPECT_GT(behind, 500u);
  for (int k = 2; k * kFrame < 1; ++k) show(k * kFrame, wall(0.5));
  for (std::size_t i = 0; i < points_->size(); ++i) EXPECT_GT(end(i).x(), -0.06);
}

TEST_F(MorphTest, ACameraThatGoesFarTakesItsOriginAlong) {
  for (int k = 0; k < 20; ++k) {
    T_world_sensor_.pretranslate(Vector3d(1, 0, 0));
    show(k * kFrame, wall(0.5));
    EXPECT_LT((points_->origin - T_world_sensor_.translation()).norm(), 17);
    for (std::size_t i = 0; i < points_->size(); i += 50) {
      EXPECT_NEAR(start(i).z(), 0, 1e-5);
      EXPECT_NEAR(end(i).z(), 0, 1e-5);
    }
  }
}

TEST_F(MorphTest, PointsThatAreNoneAreLeftOut) {
  const DepthFrame frame = frame_of(small_camera(), 0, wall(0.5));
  DepthFilter filter;
  FilteredDepth depth = filter.filter(frame, T_world_sensor_);
  depth.positions[100].z() = -0.5f;
  depth.positions[200].x() = NAN;
  depth.normals[300].y() = INFINITY;
  depth.spacings[400] = NAN;
  points_ = std::make_shared<SurfacePoints>();
  morph_.look({depth, frame.camera.pinhole});
  morph_.fill({depth, frame.camera.pinhole}, {0, 0, kFrame}, points_);
  check(*points_);
  EXPECT_EQ(points_->size(), depth.size() - 4);
}

TEST_F(MorphTest, AnotherImageSizeKeepsTheSurface) {
  show(0, wall(0.5));
  const auto show_as = [&](const CameraModel& camera, double stamp) {
    const DepthFrame frame = frame_of(camera, stamp, wall(0.5));
    DepthFilter filter;
    const FilteredDepth& depth = filter.filter(frame, T_world_sensor_);
    points_ = std::make_shared<SurfacePoints>();
    morph_.look({depth, frame.camera.pinhole});
    morph_.fill({depth, frame.camera.pinhole}, {stamp, stamp, kFrame}, points_);
    check(*points_);
  };
  show_as({80, 60, {190, 190, 39.5, 29.5}, {}}, kFrame);
  EXPECT_EQ(coming(), 0u);
  EXPECT_GT(staying(), 1000u);
  for (std::size_t i = 0; i < points_->size(); i += 7) EXPECT_NEAR(end(i).z(), 0, 1e-5);
}

TEST_F(MorphTest, AnImageWithoutDepthIsNoSurface) {
  show(0, [](double, double) { return 0.0; });
  EXPECT_EQ(points_->size(), 0u);
  show(kFrame, wall(0.5));
  EXPECT_EQ(coming(), points_->size());
}

TEST_F(MorphTest, IsTheSameEveryTime) {
  const auto run = [&] {
    morph_.forget();
    for (int k = 0; k < 5; ++k) show(k * kFrame, with_hole(0.5 + 1e-3 * k, k % 2 == 0 ? 0.4 : 0));
    return points_;
  };
  const auto first = run();
  const auto second = run();
  ASSERT_EQ(first->size(), second->size());
  EXPECT_EQ(first->end_positions, second->end_positions);
  EXPECT_EQ(first->density_weights, second->density_weights);
  EXPECT_EQ(first->cell_reach, second->cell_reach);
}

}  // namespace
}  // namespace palpate
