// A trial of walls step by step: how a wall is passed, and what ends it while a hand feels one.
#include <gtest/gtest.h>

#include <cmath>

#include "palpate/servo/z_width.hpp"

namespace palpate {
namespace {

// Somebody who presses, step by step: a millisecond each, at 1 cm/s.
class Presser {
 public:
  explicit Presser(const StiffnessTestOptions& options = {}, double maximum_force = 8)
      : trial_(device(maximum_force), options) {}

  DeviceState hand;

  double step() {
    force_ = trial_.step(hand, 1e-3 * steps_++).z();
    return force_;
  }
  void wait(double seconds) {
    for (const int end = steps_ + static_cast<int>(std::lround(1000 * seconds)); steps_ < end;) {
      step();
    }
  }
  void go_by(double way) {
    const int steps = static_cast<int>(std::lround(std::abs(way) / 1e-5));
    for (int i = 0; i < steps; ++i) {
      hand.position.z() += way / steps;
      step();
    }
  }
  // Rests until the wall is under the hand, and goes down until the force is there, N.
  void press(double force) {
    while (phase() == StiffnessTest::Phase::rest) step();
    for (int i = 0; force_ < force && i < 5000; ++i) go_by(-1e-5);
    ASSERT_GE(force_, force);
    ASSERT_EQ(phase(), StiffnessTest::Phase::press);
  }
  // Presses until the wall was held for long enough.
  void hold() {
    for (int i = 0; phase() == StiffnessTest::Phase::press && i < 5000; ++i) step();
    ASSERT_EQ(phase(), StiffnessTest::Phase::lift);
  }
  // The force goes within 5 ms of something that is wrong, and comes back for nothing.
  void expect_over(StiffnessTest::Phase why) {
    const double before = force_;
    ASSERT_LE(step(), before);
    EXPECT_EQ(phase(), why);
    wait(5e-3);
    EXPECT_EQ(force_, 0);
    hand.velocity.setZero();
    hand.status = DeviceState::Status::ok;
    wait(31);  // longer than it has patience
    EXPECT_EQ(phase(), why);
    EXPECT_EQ(force_, 0) << "over is over";
  }

  [[nodiscard]] StiffnessTest::State state() const { return trial_.state(); }
  [[nodiscard]] StiffnessTest::Phase phase() const { return trial_.state().phase; }
  [[nodiscard]] double force() const { return force_; }

 private:
  static DeviceInfo device(double maximum_force) {
    DeviceInfo info;
    info.maximum_force = maximum_force;
    return info;
  }

  StiffnessTest trial_;
  double force_ = 0;
  int steps_ = 0;
};

TEST(PressedWall, EndsWhenAHandThatPressesIsTooFast) {
  Presser presser;
  presser.press(1);
  presser.hand.velocity = {0.34, 0, -0.34};
  presser.wait(0.1);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::press) << "0.48 m/s";
  EXPECT_GT(presser.force(), 0.9);
  presser.hand.velocity = {0.4, 0, -0.4};
  presser.expect_over(StiffnessTest::Phase::too_fast);
  EXPECT_EQ(presser.state().stable, 0);
}

TEST(PressedWall, EndsWhenAHandThatLiftsIsTooFast) {
  Presser presser({.fastest = 0.2});
  presser.press(1);
  presser.hold();
  ASSERT_GT(presser.force(), 0.9);
  presser.hand.velocity = {0, 0, 0.25};
  presser.expect_over(StiffnessTest::Phase::too_fast);
  EXPECT_EQ(presser.state().stable, 0) << "nobody has lifted off it";
}

TEST(PressedWall, EndsWhenTheDeviceFails) {
  for (const bool lifts : {false, true}) {
    Presser presser;
    presser.press(1);
    if (lifts) presser.hold();
    presser.hand.status = DeviceState::Status::failed;
    presser.expect_over(StiffnessTest::Phase::device_lost);
  }
}

TEST(PressedWall, IsPutUnderARestingHandAgainAfterASilence) {
  for (const bool lifts : {false, true}) {
    Presser presser;
    presser.press(1);
    if (lifts) presser.hold();
    presser.hand.status = DeviceState::Status::silent;
    presser.wait(5e-3);
    EXPECT_EQ(presser.phase(), StiffnessTest::Phase::rest);
    EXPECT_EQ(presser.force(), 0);
    presser.hand.status = DeviceState::Status::ok;
    presser.wait(0.1);
    EXPECT_EQ(presser.force(), 0) << "it has to rest first";
    presser.press(1);
    presser.hold();
    presser.go_by(13e-3);
    EXPECT_EQ(presser.state().stable, 100) << "the wall that it was at";
  }
}

TEST(PressedWall, APlaceThatIsNoNumberTakesTheForceAtOnce) {
  Presser presser;
  presser.press(1);
  presser.hand.position.x() = std::nan("");
  EXPECT_EQ(presser.step(), 0);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::device_lost);
}

TEST(PressedWall, AWallIsStableOnceItWasHeldAndLeft) {
  Presser presser;
  presser.press(0.5);
  presser.wait(0.4);
  EXPECT_GT(presser.state().pressed, 0.4);
  presser.go_by(12e-3);
  EXPECT_EQ(presser.state().pressed, 0);
  presser.press(0.5);
  presser.wait(0.6);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::press) << "for a second without a pause";
  presser.hold();
  presser.go_by(6.5e-3);  // 0.5 N are 5 mm
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::lift) << "1.5 mm over the wall";
  EXPECT_EQ(presser.state().stable, 0);
  presser.go_by(1e-3);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::press);
  EXPECT_EQ(presser.state().stable, 100);
  EXPECT_DOUBLE_EQ(presser.state().wall, 115);
}

TEST(PressedWall, GivesUpAHandThatNeverLiftsOrNeverPressesAgain) {
  Presser stays({.patience = 3});
  stays.press(0.5);
  stays.hold();
  stays.go_by(6e-3);
  stays.wait(2.2);
  EXPECT_EQ(stays.phase(), StiffnessTest::Phase::lift);
  stays.wait(0.3);
  EXPECT_EQ(stays.phase(), StiffnessTest::Phase::timed_out);
  EXPECT_EQ(stays.state().stable, 0);
  Presser leaves({.patience = 3});
  leaves.press(0.5);
  leaves.hold();
  leaves.go_by(12e-3);
  leaves.wait(2.4);
  EXPECT_EQ(leaves.phase(), StiffnessTest::Phase::press) << "patience begins anew with each phase";
  leaves.wait(0.6);
  EXPECT_EQ(leaves.phase(), StiffnessTest::Phase::timed_out);
  EXPECT_EQ(leaves.state().stable, 100) << "what was found stays";
}

TEST(PressedWall, GivesUpAHandThatIsNeverStill) {
  Presser presser;
  presser.hand.velocity = {0.03, 0, 0};
  presser.wait(29.9);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::rest);
  presser.wait(0.2);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::timed_out);
}

TEST(PressedWall, AForceAtItsBoundProvesNothing) {
  Presser presser({}, 0.88);  // a Touch's: 0.7 N
  presser.press(0.7);
  presser.go_by(-3e-3);
  presser.wait(3);
  EXPECT_EQ(presser.phase(), StiffnessTest::Phase::press);
  EXPECT_EQ(presser.state().pressed, 0);
}

}  // namespace
}  // namespace palpate
