#include <gtest/gtest.h>

#include <algorithm>

#include "base/numbers.hpp"
#include "depth/temporal_filter.hpp"
#include "depth/temporal_frames.hpp"
#include "support/effort.hpp"

namespace palpate::depth {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::BlockErrors;
using test::BlockScene;
using test::errors_of;

constexpr double kWarpSd = 1e-4;
constexpr double kWarpSlopeSd = 4e-3;

Isometry3d turned(double angle, const Vector3d& axis, const Vector3d& shift = Vector3d::Zero()) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  pose.translation() = shift;
  return pose;
}

class TemporalWarpTest : public ::testing::Test {
 protected:
  TemporalWarpTest() { fits_.resize(test::block_camera(120, 90)); }

  void show(const BlockScene& scene, const Isometry3d& pose, double sd = kWarpSd) {
    test::measure(scene, pose, sd, kWarpSlopeSd, random_, fits_);
    test::filter(filter_, {}, pose, fits_);
  }

  /// An image in which nothing is measured; fits_ gets what is remembered.
  void show_nothing(const Isometry3d& pose) {
    std::fill(fits_.states.begin(), fits_.states.end(), FilteredDepth::State::empty);
    test::filter(filter_, {}, pose, fits_);
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      const BlockMemory& m = filter_.memory()[i];
      fits_.states[i] = m.count > 0 ? m.state : FilteredDepth::State::empty;
      fits_.rho[i] = m.rho;
      fits_.slope_x[i] = m.slope_x;
      fits_.slope_y[i] = m.slope_y;
    }
  }

  /// Blocks of which no frame but the last is remembered.
  [[nodiscard]] std::ptrdiff_t begun() const {
    return std::ranges::count(filter_.memory(), 1, &BlockMemory::count);
  }

  BlockFits fits_;
  TemporalFilter filter_;
  Random random_{2};
};

TEST_F(TemporalWarpTest, APlaneIsTheSamePlaneInEveryView) {
  const BlockScene scene{.plane_normal = Vector3d(0.3, -0.4, -1).normalized()};
  const Isometry3d before = turned(0.2, Vector3d(1, 2, 3).normalized(), {0.1, 0, 0});
  test::measure(scene, before, 0, 0, random_, fits_);
  test::filter(filter_, {}, before, fits_);
  const Isometry3d after =
      before * turned(0.04, Vector3d(-1, 1, 1).normalized(), {0.02, 0.01, 0.03});
  show_nothing(after);
  const BlockErrors errors = errors_of(fits_, scene, after);
  EXPECT_GT(errors.count, 8000);
  EXPECT_LT(errors.worst, 2e-6);
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    if (fits_.states[i] == FilteredDepth::State::empty) continue;
    const Vector3d tangent = test::tangent_at(scene, after.inverse(), 0, 0);
    ASSERT_NEAR(fits_.slope_x[i], tangent.x(), 1e-5);
    ASSERT_NEAR(fits_.slope_y[i], tangent.y(), 1e-5);
  }
}

TEST_F(TemporalWarpTest, ATurnByOneBlockAndBackLosesNothing) {
  const BlockScene scene{.ball_radius = 0.06};
  const Isometry3d start = Isometry3d::Identity();
  const Isometry3d aside = turned(2 / 525.0, Vector3d::UnitY());
  for (int frame = 0; frame < 8; ++frame) show(scene, start);
  const double still = errors_of(fits_, scene, start, 0, 3).rms;
  show(scene, aside);
  show(scene, start);
  // The columns that had left the image are new; all others remember eight frames.
  EXPECT_LE(begun(), 2 * 90 + 200);
  EXPECT_LT(errors_of(fits_, scene, start, 0, 3).rms, 1.2 * still);
  EXPECT_EQ(errors_of(fits_, scene, start).count,
            errors_of(fits_, scene, start, 0).count + errors_of(fits_, scene, start, 1).count);
}

// 5 cm/s and 10 degrees a second at 30 frames a second.
TEST_F(TemporalWarpTest, AMovingCameraKeepsWhatTheFilterHasGained) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  const BlockScene scene{.plane_normal = Vector3d(0, 0.4, -1).normalized(), .ball_radius = 0.06};
  Random same(2);
  BlockFits raw;
  raw.resize(fits_.grid);
  double filtered_plane = 0;
  double raw_plane = 0;
  double filtered_ball = 0;
  double raw_ball = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const double t = frame / 30.0;
    const Isometry3d pose =
        turned(10 * kDegree * (t - 0.6), Vector3d(0.3, 1, 0.2).normalized(), {0.05 * t, 0, 0});
    show(scene, pose);
    test::measure(scene, pose, kWarpSd, kWarpSlopeSd, same, raw);
    ASSERT_EQ(errors_of(fits_, scene, pose).count, errors_of(raw, scene, pose).count);
    if (frame < 10) continue;
    filtered_plane += errors_of(fits_, scene, pose, 0, 4).rms;
    raw_plane += errors_of(raw, scene, pose, 0, 4).rms;
    filtered_ball += errors_of(fits_, scene, pose, 1, 4).rms;
    raw_ball += errors_of(raw, scene, pose, 1, 4).rms;
    ASSERT_LT(errors_of(fits_, scene, pose, -1, 4).worst, 0.6e-3);
  }
  EXPECT_LT(filtered_plane, 0.5 * raw_plane);
  EXPECT_LT(filtered_ball, raw_ball);
}

TEST_F(TemporalWarpTest, TheNearerSurfaceHidesTheOther) {
  const BlockScene scene{.ball_center = {0.0, 0, 0.6}, .ball_radius = 0.05};
  const Isometry3d start = Isometry3d::Identity();
  const Isometry3d aside = turned(0, Vector3d::UnitY(), {0.03, 0, 0});
  test::measure(scene, start, 0, 0, random_, fits_);
  test::filter(filter_, {}, start, fits_);
  show_nothing(aside);
  // What the new view sees of the ball is ball or not known, never the plane behind it.
  const Isometry3d T_sensor_world = aside.inverse();
  int ball = 0;
  for (int row = 0; row < fits_.grid.rows; ++row) {
    for (int column = 0; column < fits_.grid.columns; ++column) {
      const double x = fits_.grid.x(column);
      const double y = fits_.grid.y(row);
      bool inside = true;
      for (const int d : {-3, 0, 3}) {
        bool there = false;
        test::tangent_at(scene, T_sensor_world, fits_.grid.x(column + d), y, &there);
        inside = inside && there;
        test::tangent_at(scene, T_sensor_world, x, fits_.grid.y(row + d), &there);
        inside = inside && there;
      }
      const std::size_t i = fits_.grid.index(column, row);
      if (!inside || fits_.states[i] == FilteredDepth::State::empty) continue;
      const Vector3d tangent = test::tangent_at(scene, T_sensor_world, x, y);
      ASSERT_NEAR(1 / fits_.rho[i], 1 / tangent.dot(Vector3d(x, y, 1)), 0.01);
      ++ball;
    }
  }
  EXPECT_GT(ball, 200);
}

TEST_F(TemporalWarpTest, WhatTheCameraNewlySeesStartsAnew) {
  const BlockScene scene{
      .plane_point = {0, 0, 1.2}, .ball_center = {0, 0, 0.6}, .ball_radius = 0.05};
  show(scene, Isometry3d::Identity());
  show(scene, Isometry3d::Identity());
  EXPECT_EQ(begun(), 0);
  show(scene, turned(0, Vector3d::UnitY(), {0.02, 0, 0}));
  EXPECT_GT(begun(), 50);  // beside the ball, which covers other blocks now
  EXPECT_LT(begun(), 3000);
}

TEST_F(TemporalWarpTest, WhateverComesStaysFinite) {
  int found = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const auto draw = [&] { return 2 * random_.uniform() - 1; };
    const Isometry3d pose =
        turned(3 * draw(), Vector3d(draw(), draw(), 1.1).normalized(), {draw(), draw(), draw()});
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      const double kind = random_.uniform();
      fits_.states[i] = kind < 0.2   ? FilteredDepth::State::empty
                        : kind < 0.5 ? FilteredDepth::State::plain
                                     : FilteredDepth::State::fitted;
      fits_.rho[i] = static_cast<float>(0.05 + 10 * random_.uniform());
      fits_.variance[i] = static_cast<float>(random_.uniform());
      fits_.slope_x[i] = static_cast<float>(100 * draw());
      fits_.slope_y[i] = static_cast<float>(100 * draw());
      fits_.slope_variance[i] = static_cast<float>(random_.uniform());
      fits_.confidences[i] = random_.uniform() < 0.5 ? 0.0F : 1.0F;
    }
    test::filter(filter_, {}, pose, fits_);
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      if (fits_.states[i] == FilteredDepth::State::empty) continue;
      ASSERT_TRUE(std::isfinite(fits_.rho[i]) && fits_.rho[i] > 0);
      ASSERT_TRUE(std::isfinite(fits_.slope_x[i]) && std::isfinite(fits_.slope_y[i]));
      ASSERT_TRUE(std::isfinite(fits_.variance[i]) && fits_.variance[i] >= 0);
      ++found;
    }
  }
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace palpate::depth
