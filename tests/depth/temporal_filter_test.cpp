#include "depth/temporal_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "depth/temporal_frames.hpp"

namespace palpate::depth {
namespace {

using test::BlockErrors;
using test::BlockScene;
using test::errors_of;

constexpr double kSd = 5e-5;       // of rho, 1/m: 0.03 mm at 0.8 m
constexpr double kSlopeSd = 4e-3;  // 1/m: 0.2 degrees
const Eigen::Isometry3d kStill = Eigen::Isometry3d::Identity();

double depth_sd(double z) {
  return kSd * z * z;
}

class TemporalFilterTest : public ::testing::Test {
 protected:
  TemporalFilterTest() { fits_.resize(test::block_camera(60, 50)); }

  /// One frame of `scene`.
  void show(const BlockScene& scene, const TemporalOptions& options = {},
            const Eigen::Isometry3d& pose = kStill) {
    test::measure(scene, pose, kSd, kSlopeSd, random_, fits_);
    test::filter(filter_, options, pose, fits_);
  }

  /// Blocks of which no frame but the last is remembered.
  [[nodiscard]] std::ptrdiff_t begun() const {
    return std::ranges::count(filter_.memory(), 1, &BlockMemory::count);
  }

  BlockFits fits_;
  TemporalFilter filter_;
  Random random_{1};
};

TEST_F(TemporalFilterTest, AStillPlanesNoiseFallsAsTheRootOfTheFrames) {
  const BlockScene scene{.plane_normal = Eigen::Vector3d(0.2, 0.3, -1).normalized()};
  for (int frame = 1; frame <= 8; ++frame) {
    show(scene);
    const BlockErrors errors = errors_of(fits_, scene, kStill);
    EXPECT_EQ(errors.count, 3000);
    // Blocks beyond the gate of five deviations start anew: none in so few.
    const double expected = depth_sd(0.8) / std::sqrt(frame);
    EXPECT_NEAR(errors.rms, expected, 0.2 * expected) << frame;
    EXPECT_NEAR(fits_.variance[0], kSd * kSd / frame, 1e-3 * kSd * kSd);
    EXPECT_NEAR(fits_.slope_variance[0], kSlopeSd * kSlopeSd / frame, 1e-3 * kSlopeSd * kSlopeSd);
    EXPECT_EQ(begun(), frame == 1 ? 3000 : 0);
  }
}

TEST_F(TemporalFilterTest, SlopesAreAveragedAlike) {
  const BlockScene scene;
  for (int frame = 0; frame < 20; ++frame) show(scene);
  double squares = 0;
  for (std::size_t i = 0; i < fits_.size(); ++i) squares += fits_.slope_x[i] * fits_.slope_x[i];
  const double sd = std::sqrt(squares / static_cast<double>(fits_.size()));
  EXPECT_LT(sd, kSlopeSd / 3);  // a running mean of weight 1/8 ends at 1 / sqrt(15)
}

// Rims do that: a fit's window depends on the noise there.
TEST_F(TemporalFilterTest, FitsThatScatterMoreThanTheySayAreAveragedAllTheSame) {
  constexpr double kTimes = 10;
  for (int frame = 0; frame < 60; ++frame) {
    test::measure({}, kStill, kTimes * kSd, kTimes * kSlopeSd, random_, fits_);
    std::ranges::fill(fits_.variance, static_cast<float>(kSd * kSd));
    std::ranges::fill(fits_.slope_variance, static_cast<float>(kSlopeSd * kSlopeSd));
    test::filter(filter_, {}, kStill, fits_);
  }
  EXPECT_LT(begun(), 30);
  EXPECT_LT(errors_of(fits_, {}, kStill).rms, 0.5 * kTimes * depth_sd(0.8));
  double sum = 0;
  for (const float variance : fits_.variance) sum += variance;
  const double told = std::sqrt(8 * sum / static_cast<double>(fits_.size())) / kSd;
  EXPECT_NEAR(told, kTimes, 0.2 * kTimes);
}

TEST_F(TemporalFilterTest, AMemoryOfOneFrameChangesNothing) {
  const TemporalOptions options{.memory = 1};
  for (int frame = 0; frame < 3; ++frame) {
    test::measure({}, kStill, kSd, kSlopeSd, random_, fits_);
    const std::vector<float> rho = fits_.rho;
    test::filter(filter_, options, kStill, fits_);
    EXPECT_EQ(fits_.rho, rho);
  }
}

TEST_F(TemporalFilterTest, AMovingPlaneIsWhereItIsMeasured) {
  for (const double speed : {0.02, 0.1, 0.2}) {
    SCOPED_TRACE(speed);
    filter_.reset();
    BlockScene scene;
    for (int frame = 0; frame < 30; ++frame) {
      scene.plane_point.z() = 0.8 - speed * frame / 30;
      show(scene);
      const BlockErrors errors = errors_of(fits_, scene, kStill);
      EXPECT_EQ(errors.count, 3000);
      // Behind the newest frame by what the gate lets pass, and by less than a frame's way.
      EXPECT_LT(std::abs(errors.mean), std::min(speed / 30, 2 * depth_sd(0.8)));
    }
  }
}

TEST_F(TemporalFilterTest, WhatComesSlowlyIsNotTakenForStill) {
  BlockScene scene;
  const double way = 5 * depth_sd(0.8);  // of a frame, which alone would be within the gate
  for (int frame = 0; frame < 40; ++frame) {
    scene.plane_point.z() = 0.8 - way * frame;
    show(scene);
    if (frame >= 5) {
      EXPECT_LT(std::abs(errors_of(fits_, scene, kStill).mean), 0.3 * depth_sd(0.8)) << frame;
    }
  }
}

TEST_F(TemporalFilterTest, ABallThatMovesDoesNotSmear) {
  BlockScene scene{.ball_radius = 0.06};
  for (int frame = 0; frame < 40; ++frame) {
    scene.ball_center = {-0.07 + 0.1 * frame / 30, 0, 0.7};  // 10 cm/s across the view
    show(scene);
    const BlockErrors errors = errors_of(fits_, scene, kStill, 1);
    ASSERT_GT(errors.count, 300);
    ASSERT_LT(errors.rms, 2 * depth_sd(0.7));
    ASSERT_LT(errors.worst, 20 * depth_sd(0.7));
    const BlockErrors behind = errors_of(fits_, scene, kStill, 0);
    ASSERT_LT(behind.worst, 20 * depth_sd(0.8));
  }
}

TEST_F(TemporalFilterTest, WhatStopsDoesNotRunAhead) {
  BlockScene scene;
  for (int frame = 0; frame < 20; ++frame) {
    scene.plane_point.z() = 0.8 - 0.1 * std::min(frame, 10) / 30;
    show(scene);
    if (frame <= 10) continue;
    EXPECT_LT(std::abs(errors_of(fits_, scene, kStill).mean), 0.2 * depth_sd(0.8));
    EXPECT_LT(errors_of(fits_, scene, kStill).worst, 6 * depth_sd(0.8));
  }
  // Still again: averaged again.
  EXPECT_LT(errors_of(fits_, scene, kStill).rms, 0.5 * depth_sd(0.8));
}

TEST_F(TemporalFilterTest, AnotherSurfaceReplacesTheOldOneAtOnce) {
  for (int frame = 0; frame < 5; ++frame) show({.plane_point = {0, 0, 0.6}});
  const BlockScene behind{.plane_point = {0, 0, 0.8}};
  show(behind);
  EXPECT_EQ(begun(), 3000);
  EXPECT_LT(errors_of(fits_, behind, kStill).worst, 6 * depth_sd(0.8));
  show(behind);
  EXPECT_EQ(begun(), 0);
}

TEST_F(TemporalFilterTest, WhatIsNotMeasuredIsRememberedForAWhile) {
  const TemporalOptions options{.hold = 3};
  const auto hide = [&](int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      test::measure({}, kStill, kSd, kSlopeSd, random_, fits_);
      fits_.states[7] = FilteredDepth::State::empty;
      fits_.rho[7] = 0;
      test::filter(filter_, options, kStill, fits_);
      EXPECT_EQ(fits_.states[7], FilteredDepth::State::empty);
      EXPECT_EQ(filter_.memory()[8].missed, 0);
    }
  };
  for (int frame = 0; frame < 5; ++frame) show({}, options);
  const float last = fits_.rho[7];
  hide(3);
  EXPECT_EQ(filter_.memory()[7].missed, 3);
  EXPECT_EQ(filter_.memory()[7].rho, last);
  show({}, options);  // goes on with its sixth frame
  EXPECT_EQ(filter_.memory()[7].count, 6);
  EXPECT_NEAR(fits_.variance[7], kSd * kSd / 6, 1e-3 * kSd * kSd);
  hide(4);
  EXPECT_EQ(filter_.memory()[7].count, 0);
  show({}, options);
  EXPECT_EQ(filter_.memory()[7].count, 1);
}

TEST_F(TemporalFilterTest, WhatComesBackElsewhereStartsAnew) {
  for (int frame = 0; frame < 5; ++frame) show({.plane_point = {0, 0, 0.6}});
  std::fill(fits_.states.begin(), fits_.states.end(), FilteredDepth::State::empty);
  test::filter(filter_, {}, kStill, fits_);
  EXPECT_EQ(begun(), 0);
  show({});
  EXPECT_EQ(begun(), 3000);
}

TEST_F(TemporalFilterTest, ABlockThatBecomesFittedStartsAnew) {
  const auto show_plain = [&](double z) {
    test::measure({.plane_point = {0, 0, z}}, kStill, 20 * kSd, kSlopeSd, random_, fits_);
    std::fill(fits_.states.begin(), fits_.states.end(), FilteredDepth::State::plain);
    test::filter(filter_, {}, kStill, fits_);
  };
  for (int frame = 0; frame < 5; ++frame) show_plain(0.8);
  show({});
  EXPECT_EQ(begun(), 3000);
  EXPECT_LT(errors_of(fits_, {}, kStill).worst, 6 * depth_sd(0.8));
  EXPECT_NEAR(fits_.variance[0], kSd * kSd, 1e-3 * kSd * kSd);
  show_plain(0.8);
  EXPECT_EQ(begun(), 3000);
}

TEST_F(TemporalFilterTest, WhatIsLessSureThanWantedRemembersLonger) {
  for (const double wanted : {0.0, kSlopeSd * 0.8 / 2}) {  // 1 / rho = 0.8 m; four times the memory
    filter_.reset();
    for (int frame = 0; frame < 40; ++frame) show({}, {.normal_error = wanted});
    ASSERT_EQ(filter_.memory().size(), fits_.size());
    for (const BlockMemory& m : filter_.memory()) EXPECT_NEAR(m.count, wanted > 0 ? 32 : 8, 1);
  }
}

TEST_F(TemporalFilterTest, BlocksWithoutSlopesDoNotSpoilThem) {
  for (int frame = 0; frame < 8; ++frame) show({});
  test::measure({}, kStill, kSd, kSlopeSd, random_, fits_);
  const float slope = 0.5F;
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    fits_.confidences[i] = fits_.slope_variance[i] = 0;
    fits_.slope_x[i] = slope;  // means nothing
  }
  test::filter(filter_, {}, kStill, fits_);
  for (std::size_t i = 0; i < fits_.size(); ++i) {
    ASSERT_LT(std::abs(fits_.slope_x[i]), 5 * kSlopeSd);
    ASSERT_NEAR(fits_.confidences[i], 7.0 / 8, 1e-5);
  }
}

TEST_F(TemporalFilterTest, ForgetsOnResetAndOnAnotherGrid) {
  show({});
  show({});
  filter_.reset();
  show({});
  EXPECT_EQ(begun(), 3000);
  fits_.resize(test::block_camera(40, 30));
  show({});
  EXPECT_EQ(filter_.memory().size(), 1200U);
  EXPECT_EQ(begun(), 1200);
}

TEST(TemporalOptions, FollowTheNoise) {
  EXPECT_EQ(temporal_options(8, 1, 0).gate, 5);
  EXPECT_EQ(temporal_options(8, 3.5, 0).gate, 5);
  EXPECT_EQ(temporal_options(8, 7, 0).gate, 7);
  EXPECT_EQ(temporal_options(1000, 1, 0).memory, 255);
}

}  // namespace
}  // namespace palpate::depth
