// A camera's clock that is set while it runs, from its stamps to what its source is asked.
#include "sensor/camera_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palpate/scene/scene.hpp"
#include "sensor/stream_fixture.hpp"
#include "support/contains.hpp"
#include "support/depth_frames.hpp"

namespace palpate {
namespace {

using namespace sensor;
using test::contains;

constexpr double kFrame = 1. / 30;  // s

TEST(CameraClock, LeavesStampsThatGrowAsTheyAre) {
  CameraClock clock;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> delay(0.005, 0.4);
  double arrival = 0;
  for (int k = 0; k < 200; ++k) {
    arrival = std::max(arrival, k * kFrame + delay(random));
    EXPECT_EQ(clock.on_stream(k * kFrame, arrival), k * kFrame);
    EXPECT_EQ(clock.set_back(), 0);
  }
}

TEST(CameraClock, TakesOneOldFrameForALateOne) {
  CameraClock clock;
  EXPECT_EQ(clock.on_stream(5, 5.02), 5);
  EXPECT_EQ(clock.on_stream(4.9, 5.03), 4.9);
  EXPECT_EQ(clock.on_stream(5.1, 5.12), 5.1);
  EXPECT_TRUE(std::isnan(clock.on_stream(std::nan(""), 5.2)));
  EXPECT_EQ(clock.on_stream(5.2, 5.22), 5.2);
}

/// Frames of a camera whose clock is ahead by `shift`, taken 20 ms before they come.
double taken_at(CameraClock& clock, double now, double shift) {
  return clock.on_stream(now - 0.02 + shift, now);
}

TEST(CameraClock, GoesOnWhereItIsSetBackOrForwardAndRightAgain) {
  for (const double set : {-2.0, -0.1, 5.0}) {
    CameraClock clock;
    double now = 0;
    const auto pass = [&](int frames, double shift) {
      double told = 0;
      for (int k = 0; k < frames; ++k, now += kFrame) {
        const double taken = taken_at(clock, now, shift);
        EXPECT_TRUE(k == 0 || std::abs(taken - now + 0.02) < 1e-9) << set << " " << k;
        told += clock.set_back();
      }
      return told;
    };
    EXPECT_EQ(pass(30, 0), 0);
    EXPECT_NEAR(pass(30, set), -set, 1e-9);
    pass(30, 0);
  }
}

// The first frame after it is set is slow; from the next quick one on nothing is too young.
TEST(CameraClock, IsRightOnceAFrameIsAsQuickAsBefore) {
  CameraClock clock;
  EXPECT_EQ(taken_at(clock, 1, 0), 0.98);
  (void)clock.on_stream(1 - 2, 1.3);
  EXPECT_NEAR(clock.on_stream(1.1 - 2, 1.4), 1.38, 1e-9) << "0.28 s too young";
  EXPECT_NEAR(taken_at(clock, 1.5, -2), 1.48, 1e-9);
  EXPECT_NEAR(taken_at(clock, 1.6, -2), 1.58, 1e-9);
}

class ASource : public StreamTest {
 protected:
  ASource() { (void)seen(); }

  [[nodiscard]] Seen seen() const {
    return source_.seen(Ball{{0, 0, 0.05}, 1e-3}, clock_.now()).value_or(Seen{});
  }
  /// A frame 20 ms old, of a wall or of nothing, by a clock that is ahead by `shift`; waits until
  /// it has come to the source.
  void sees(const Stream& stream, double depth, double shift, bool taken = true) {
    const double now = clock_.now() + kFrame;
    const test::DepthOf depths = depth > 0 ? test::wall(depth) : [](double, double) { return 0.0; };
    give(stream, now, test::frame_of(test::small_camera(), now - 0.02 + shift, depths));
    prepared_ += taken && depth > 0 ? 1 : 0;
    expect_touchable(stream, prepared_);
  }

  Scene scene_;
  Source& source_ = scene_.add("camera", {.T_world_sensor = test::looking_down()});
  std::uint64_t prepared_ = 0;
};

TEST_F(ASource, SeesOnWithACameraWhoseClockIsSetBack) {
  const Stream stream(camera(true, true), source_, clock_, {.stall = kNever});
  for (int k = 0; k < 30; ++k) sees(stream, 0.5, 0);
  ASSERT_EQ(seen().verdict, Seen::Verdict::free);
  sees(stream, 0.5, -2, false);
  for (int k = 0; k < 30; ++k) {
    sees(stream, 0.5, -2);
    EXPECT_EQ(seen().verdict, Seen::Verdict::free) << k;
    EXPECT_NEAR(seen().age, 0.02, 1e-9) << k;
  }
  EXPECT_TRUE(contains(stream.state().problem, "its clock was set back by 2.0"))
      << stream.state().problem;
  EXPECT_EQ(stream.state().drops.late, 1u);
}

TEST_F(ASource, SaysThatNothingIsMeasuredWhereImagesAreEmpty) {
  const Stream stream(camera(true, true), source_, clock_, {.stall = kNever});
  for (int k = 0; k < 30; ++k) sees(stream, 0.5, 0);
  ASSERT_EQ(seen().verdict, Seen::Verdict::free);
  for (int k = 0; k < 30; ++k) {
    sees(stream, 0, 0);
    if (k < 2) continue;  // the one before counts for a frame
    EXPECT_TRUE(eventually([&] { return seen().verdict == Seen::Verdict::nothing; })) << k;
  }
  EXPECT_EQ(stream.state().drops.empty, 30u);
}

TEST_F(ASource, IsAsOldAsItsNewestFrame) {
  const Stream stream(camera(true, true), source_, clock_, {.stall = kNever});
  EXPECT_EQ(stream.state().age, 0);
  sees(stream, 0.5, -4.9);
  EXPECT_NEAR(stream.state().age, 4.92, 1e-9);
}

}  // namespace
}  // namespace palpate
