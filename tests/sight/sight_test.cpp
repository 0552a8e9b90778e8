// Checks what raw frames say of balls before, in and behind a surface.
#include "sight/sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "support/depth_frames.hpp"

namespace palpate {
namespace {

using namespace test;
using Eigen::Vector3d;
using Verdict = Seen::Verdict;

constexpr double kPixelSigma = 1e-3;   // m
constexpr double kFramePeriod = 0.03;  // s
constexpr double kFrameLasts = 0.1;    // s
constexpr FrameLimits kLimits = {kFrameLasts, kFrameLasts};
const NoiseModel kPixelNoise{{kPixelSigma, 0, 0}, 1};

// Frames of what a camera at the origin sees along +z, kFramePeriod apart.
class ASight : public ::testing::Test {
 protected:
  void sees(const DepthOf& depth, double noise = 0, unsigned seed = 1) {
    stamp_ += kFramePeriod;
    sight_.see(frame_of(small_camera(), stamp_, depth, noise, seed), Eigen::Isometry3d::Identity(),
               kPixelNoise);
  }
  [[nodiscard]] Seen at(const Vector3d& place, double radius = 0, double later = 0) {
    return *sight_.at({place, radius}, stamp_ + later, kLimits);
  }

  Sight sight_;
  double stamp_ = 0;
};

TEST_F(ASight, SaysNothingBeforeAFrameHasCome) {
  EXPECT_FALSE(sight_.at(Ball{}, 0, kLimits));
}

TEST_F(ASight, SeesNothingOfNoBalls) {
  sees(wall(0.5));
  const Seen none = *sight_.at(std::span<const Ball>(), stamp_, kLimits);
  EXPECT_EQ(none.verdict, Verdict::outside);
  EXPECT_TRUE(none.towards.allFinite());
}

TEST_F(ASight, TellsFreePlacesFromSolidOnes) {
  sees(wall(0.5));
  EXPECT_EQ(at({0, 0, 0.4}).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.4999}).verdict, Verdict::free);
  const Seen behind = at({0.01, 0, 0.52});
  EXPECT_EQ(behind.verdict, Verdict::solid);
  EXPECT_NEAR(behind.behind, 0.02, 4 * kPixelSigma);
  EXPECT_TRUE(behind.towards.isApprox(-Vector3d(0.01, 0, 0.52).normalized(), 1e-6));
}

TEST_F(ASight, TellsAllOfTheWayToWhatIsMeasuredWhereThatIsFar) {
  const NoiseModel patches{{kPixelSigma, 0, 0}, 5};  // a window errs as one pixel
  sight_.see(frame_of(small_camera(), 0, wall(0.5)), Eigen::Isometry3d::Identity(), patches);
  const auto lift = [&](double way) { return sight_.at({{0, 0, 0.5 + way}, 0}, 0, kLimits)->lift; };
  EXPECT_EQ(lift(2.9 * kPixelSigma), 0);
  EXPECT_LT(lift(3.1 * kPixelSigma), 0.3 * kPixelSigma) << "nothing jumps where it begins";
  EXPECT_NEAR(lift(20 * kPixelSigma), 20 * kPixelSigma, 0.5 * kPixelSigma);
}

TEST_F(ASight, TakesSteepSurfacesForWhatTheyAre) {
  const double turn = 70 * std::numbers::pi / 180;
  const Vector3d normal(std::sin(turn), 0, -std::cos(turn));
  sees(plane_depth({0, 0, 0.5}, normal), kPixelSigma / 4);
  EXPECT_EQ(at(Vector3d(0, 0, 0.5) + 1e-3 * normal).verdict, Verdict::free);
  EXPECT_EQ(at(Vector3d(0, 0, 0.5) - 4e-3 * normal).verdict, Verdict::solid);
}

TEST_F(ASight, IsNotMisledByAStepBesideThePlace) {
  // A block 30 mm high whose edge is 2 mm, one and a half pixels, beside the place.
  sees([](double x, double) { return x > 2e-3 / 0.5 ? 0.47 : 0.5; });
  EXPECT_EQ(at({0, 0, 0.4995}).verdict, Verdict::free);
  EXPECT_EQ(at({0.006, 0, 0.48}).verdict, Verdict::solid);
}

TEST_F(ASight, DoesNotTellWhatIsOutOfThePicture) {
  sees(wall(0.5));
  EXPECT_EQ(at({0.3, 0, 0.4}).verdict, Verdict::outside);
  EXPECT_EQ(at({0, 0, -0.4}).verdict, Verdict::outside);
}

TEST_F(ASight, DoesNotTellWhereNothingIsMeasured) {
  const auto hole = [](double x, double y) { return std::hypot(x, y) < 0.02 ? 0 : 0.5; };
  sees(hole);
  EXPECT_EQ(at({0, 0, 0.4}).verdict, Verdict::nothing);
  EXPECT_EQ(at({0.03, 0, 0.4}).verdict, Verdict::free);
}

// A wall with a square of 6 pixels in which nothing is measured.
DepthOf flickering_wall(double z) {
  return [=](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 0.0085 ? 0 : z; };
}

TEST_F(ASight, BridgesASmallHoleForOneFrame) {
  sees(wall(0.5));
  sees(flickering_wall(0.5));
  EXPECT_EQ(at({0, 0, 0.4}).verdict, Verdict::free);
  sees(flickering_wall(0.5));
  EXPECT_EQ(at({0, 0, 0.4}).verdict, Verdict::nothing);
}

TEST_F(ASight, BridgesNoHoleAroundWhichTheNewestFrameMeasuresNothing) {
  sees(wall(0.5));
  sees([](double x, double y) { return std::hypot(x, y) < 0.02 ? 0 : 0.48; });
  EXPECT_EQ(at({0, 0, 0.49}).verdict, Verdict::nothing) << "the wall came on";
}

TEST_F(ASight, BridgesNoHoleAroundWhichASurfaceCame) {
  sees(wall(0.5));
  sees(flickering_wall(0.48));
  EXPECT_EQ(at({0, 0, 0.49}).verdict, Verdict::nothing);
  EXPECT_EQ(at({0, 0, 0.47}).verdict, Verdict::free);
}

// Frames are asked for when they are kDelay old, after `lost` others that never came.
TEST_F(ASight, AsksTheFrameBeforeForOneMoreFrame) {
  constexpr double kDelay = 0.1;  // s
  constexpr FrameLimits kLong = {1, 1};
  const auto says = [&](double later) {
    return sight_.at({{0, 0, 0.4}, 0}, stamp_ + later, kLong)->verdict;
  };
  for (const int lost : {0, 1, 3}) {
    for (int k = 0; k < 20; ++k) {
      sees(wall(0.5));
      EXPECT_EQ(says(kDelay), Verdict::free);
    }
    stamp_ += lost * kFramePeriod;
    sees(flickering_wall(0.5));
    EXPECT_EQ(says(kDelay), lost == 0 ? Verdict::free : Verdict::nothing) << lost;
    EXPECT_EQ(says(kDelay + kFramePeriod - 1e-3), lost == 0 ? Verdict::free : Verdict::nothing)
        << lost;
    EXPECT_EQ(says(kDelay + kFramePeriod + 1e-3), Verdict::old) << lost;
  }
}

TEST_F(ASight, KnowsWhenFramesAreDueOfACameraWhoseClockIsAhead) {
  constexpr double kAhead = 0.2;  // s
  for (int k = 0; k < 20; ++k) {
    sees(wall(0.5));
    EXPECT_EQ(at({0, 0, 0.4}, 0, -kAhead).verdict, Verdict::free);
  }
  EXPECT_EQ(at({0, 0, 0.4}, 0, kFramePeriod - kAhead - 1e-3).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.4}, 0, kFramePeriod - kAhead + 1e-3).verdict, Verdict::old);
}

// The guide of a second robot does so before it knows the time.
TEST_F(ASight, LearnsNothingFromWhoAsksForATimeOfAnotherClock) {
  stamp_ = 1000;
  for (int k = 0; k < 20; ++k) {
    sees(wall(0.5));
    if (k == 17) (void)sight_.at(Ball{}, 0, kLimits);
    EXPECT_EQ(at({0, 0, 0.4}).verdict, Verdict::free);
  }
  EXPECT_EQ(at({0, 0, 0.4}, 0, kFramePeriod + 1e-3).verdict, Verdict::old);
}

TEST_F(ASight, IsTooOldAfterAWhile) {
  sees(wall(0.5));
  EXPECT_EQ(at({0, 0, 0.4}, 0, 0.9 * kFrameLasts).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.4}, 0, 1.1 * kFrameLasts).verdict, Verdict::old);
}

TEST_F(ASight, ForeseesWhatComesOn) {
  constexpr double kClosing = 0.5;  // m/s
  sees(wall(0.5 + kClosing * kFramePeriod));
  sees(wall(0.5));
  sees(wall(0.5 - kClosing * kFramePeriod));
  const Vector3d place(0, 0, 0.47);
  EXPECT_EQ(at(place).verdict, Verdict::free);
  const Seen later = at(place, 0, 2 * kFramePeriod);  // the wall is at 0.455 m by then
  EXPECT_EQ(later.verdict, Verdict::solid);
  EXPECT_TRUE(later.came);
  EXPECT_NEAR(later.behind, 0.015, 8 * kPixelSigma);
  for (int i = 2; i < 6; ++i) sees(wall(0.5 - i * kClosing * kFramePeriod));
  for (int i = 0; i < 8; ++i) sees(wall(0.4));
  EXPECT_FALSE(at(place).came) << "it has been there for a while";
}

TEST_F(ASight, ForeseesWhatComesOnAfterTheCamerasClockWasSetBack) {
  constexpr double kClosing = 0.5;  // m/s
  stamp_ = 100;
  for (int i = 0; i < 4; ++i) sees(wall(0.6));
  stamp_ = 1;
  for (int i = 0; i < 4; ++i) sees(wall(0.5 - i * kClosing * kFramePeriod));
  EXPECT_EQ(at({0, 0, 0.44}).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.44}, 0, 2 * kFramePeriod).verdict, Verdict::solid)
      << "the wall is at 0.425 m";
}

TEST_F(ASight, IsNotMisledByAFrameThatComesAfterANewerOne) {
  sees(wall(0.4));
  sees(wall(0.4));
  const double late = stamp_ + kFramePeriod / 2;
  sees(wall(0.4));
  sight_.see(frame_of(small_camera(), late, wall(0.5)), Eigen::Isometry3d::Identity(), kPixelNoise);
  EXPECT_EQ(at({0, 0, 0.45}).verdict, Verdict::solid);
}

// Where bent lenses see a wall and what is just before and behind it, in the middle and at the rim.
TEST_F(ASight, KnowsThatLensesBend) {
  for (const double k1 : {-0.2, 0.2}) {
    CameraModel camera = small_camera();
    camera.pinhole.fx = camera.pinhole.fy = 120;
    camera.distortion.k1 = k1;
    DepthFrame frame = frame_of(camera, stamp_ += kFramePeriod, wall(0.5));
    sight_.forget();
    sight_.see(frame, Eigen::Isometry3d::Identity(), kPixelNoise);
    for (const Vector3d& place : {Vector3d(0, 0, 0.5), Vector3d(0.24, 0.1, 0.5)}) {
      EXPECT_EQ(at(place - Vector3d(0, 0, 1e-3)).verdict, Verdict::free) << k1;
      EXPECT_EQ(at(place + Vector3d(0, 0, 5e-3)).verdict, Verdict::solid) << k1;
    }
  }
}

TEST_F(ASight, DoesNotBelieveALensBeyondWhereItsModelTurnsBack) {
  CameraModel camera = small_camera();
  camera.pinhole.fx = camera.pinhole.fy = 120;
  camera.distortion.k1 = -0.3;
  sight_.see(frame_of(camera, 0, wall(0.5)), Eigen::Isometry3d::Identity(), kPixelNoise);
  EXPECT_EQ(at({1.6 * 0.3, 0, 0.3}).verdict, Verdict::outside);
}

TEST_F(ASight, DoesNotForeseeWhatStays) {
  sees(wall(0.5));
  sees(wall(0.48));
  const double ever = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sight_.at({{0, 0, 0.4}, 0}, stamp_ + 1000, {ever, ever})->verdict, Verdict::free);
}

TEST_F(ASight, LooksAtAllOfABall) {
  // A rod 4 mm thick passes beside the middle of a ball.
  sees([](double x, double) { return std::abs(x - 0.02) < 0.004 ? 0.4 : 0.5; });
  EXPECT_EQ(at({0, 0, 0.42}).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.42}, 0.005).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.42}, 0.012).verdict, Verdict::solid);
  EXPECT_EQ(at({0, 0, 0.37}, 0.012).verdict, Verdict::free);
  EXPECT_EQ(at({0, 0, 0.47}, 0.004).verdict, Verdict::free);
  EXPECT_EQ(at({-0.03, 0, 0.47}, 0.04).verdict, Verdict::solid);
}

TEST_F(ASight, IsNotAlarmedByNoise) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    sees(wall(0.5), kPixelSigma, seed);
    EXPECT_EQ(at({0.01, -0.01, 0.5}, 0, kFramePeriod).verdict, Verdict::free) << seed;
    EXPECT_EQ(at({0.01, -0.01, 0.508}, 0, kFramePeriod).verdict, Verdict::solid) << seed;
  }
}

}  // namespace
}  // namespace palpate
