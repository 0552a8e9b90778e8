#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/servo/z_width.hpp"
#include "servo/oscillation.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// Somebody who does what the trial says, at a hand's pace.
class ObedientHand final : public TargetSource {
 public:
  explicit ObedientHand(const StiffnessTest& trial) : trial_(trial) {}

  [[nodiscard]] TargetSource::Target target(double, const Vector3d&) noexcept override {
    const bool presses = trial_.state().phase == StiffnessTest::Phase::press;
    const bool rests = trial_.state().phase == StiffnessTest::Phase::rest || trial_.is_over();
    const double goal = rests ? height_ : presses ? -12e-3 : 0;
    const double most = 2e-5;  // 2 cm/s
    height_ += std::clamp(goal - height_, -most, most);
    return {{0, 0, height_}, 0};
  }

 private:
  const StiffnessTest& trial_;
  double height_ = 0;
};

struct Tried {
  StiffnessTest::State state;
  double longest_force = 0;     // N
  double force_when_over = -1;  // N, 20 ms after the end
  double seconds = 0;
};

Tried try_walls(const SimulatedDeviceOptions& made, const StiffnessTestOptions& options) {
  SimulatedDevice plain(made);
  StiffnessTest trial(plain.info(), options);
  ObedientHand hand(trial);
  SimulatedDevice device(made, hand);
  Tried tried;
  int after = 0;
  for (int i = 0; i < 200'000 && after < 20; ++i) {
    const DeviceState state = device.read();
    const Vector3d force = trial.step(state, state.time);
    device.write(force);
    tried.longest_force = std::max(tried.longest_force, force.norm());
    if (trial.is_over()) ++after;
    tried.force_when_over = force.norm();
    tried.seconds = state.time;
  }
  tried.state = trial.state();
  return tried;
}

// A light grip: what is measured is that of device and hand together.
SimulatedDeviceOptions gripped() {
  SimulatedDeviceOptions device;
  device.coulomb = 0;
  device.hand = {.stiffness = 100, .damping = 1, .maximum_force = 8};
  return device;
}

TEST(StiffnessTest, FindsTheStiffnessAtWhichADeviceBeginsToShake) {
  const Tried tried = try_walls(gripped(), {});
  EXPECT_EQ(tried.state.phase, StiffnessTest::Phase::unstable);
  const double theory = passive_stiffness(0.5 + 1, 1e-3, 1e-3);
  EXPECT_GT(tried.state.stable, 0.45 * theory) << "steps of the encoders make it shake before";
  EXPECT_LT(tried.state.stable, theory);
  EXPECT_LE(tried.longest_force, 2 + 1e-9);
  EXPECT_EQ(tried.force_when_over, 0);
}

TEST(StiffnessTest, ADamperInTheWallAllowsMore) {
  const double without = try_walls(gripped(), {}).state.stable;
  EXPECT_GT(try_walls(gripped(), {.damping = 1}).state.stable, 1.2 * without);
}

TEST(StiffnessTest, EndsWhereTheStiffestWallStandsStill) {
  const Tried tried = try_walls(gripped(), {.stiffest = 300});
  EXPECT_EQ(tried.state.phase, StiffnessTest::Phase::held);
  EXPECT_EQ(tried.state.stable, 300);
}

// What a trial ends in, or is at, whose hand stays as it is.
StiffnessTest::Phase after(const DeviceState& hand, double seconds) {
  DeviceInfo info;
  info.maximum_force = 8;
  StiffnessTest trial(info);
  for (int i = 0; i < static_cast<int>(1000 * seconds) && !trial.is_over(); ++i) {
    static_cast<void>(trial.step(hand, 1e-3 * i));
  }
  EXPECT_EQ(trial.step(hand, seconds), Vector3d::Zero());
  EXPECT_FALSE(in_words(trial.state().phase).empty());
  return trial.state().phase;
}

TEST(StiffnessTest, EndsWhenSomethingIsWrong) {
  EXPECT_EQ(after({}, 1), StiffnessTest::Phase::press);
  EXPECT_EQ(after({}, 60), StiffnessTest::Phase::timed_out);
  EXPECT_EQ(after({.velocity = {0, 0.6, 0}}, 1), StiffnessTest::Phase::too_fast);
  EXPECT_EQ(after({.status = DeviceState::Status::silent}, 1), StiffnessTest::Phase::rest)
      << "not heard yet";
  EXPECT_EQ(after({.status = DeviceState::Status::silent}, 60), StiffnessTest::Phase::device_lost);
  EXPECT_EQ(after({.status = DeviceState::Status::failed}, 1), StiffnessTest::Phase::device_lost);
  EXPECT_EQ(after({.position = {0, 0, std::nan("")}}, 1), StiffnessTest::Phase::device_lost);
}

TEST(StiffnessTest, WallsGoNoFurtherThanTheMakerAllows) {
  SimulatedDeviceOptions made = gripped();
  DeviceInfo info = SimulatedDevice(made).info();
  info.maximum_stiffness = 150;
  StiffnessTest trial(info);
  ObedientHand hand(trial);
  SimulatedDevice device(made, hand);
  for (int i = 0; i < 60'000 && !trial.is_over(); ++i) {
    const DeviceState state = device.read();
    device.write(trial.step(state, state.time));
  }
  EXPECT_EQ(trial.state().phase, StiffnessTest::Phase::held);
  EXPECT_EQ(trial.state().stable, 150);
}

TEST(StiffnessTest, RefusesWhatCannotBeMeasured) {
  DeviceInfo info;
  EXPECT_THROW(StiffnessTest{info}, Error) << "renders no force";
  info.maximum_force = 8;
  EXPECT_THROW(StiffnessTest(info, {.softest = 0}), Error);
  EXPECT_THROW(StiffnessTest(info, {.softest = 500, .stiffest = 100}), Error);
  EXPECT_THROW(StiffnessTest(info, {.factor = 1}), Error);
  EXPECT_THROW(StiffnessTest(info, {.damping = -1}), Error);
  EXPECT_THROW(StiffnessTest(info, {.hold = 0}), Error);
  EXPECT_THROW(StiffnessTest(info, {.patience = 0}), Error);
  EXPECT_THROW(StiffnessTest(info, {.maximum_force = 20}), Error);
  EXPECT_THROW(StiffnessTest(info, {.fastest = 0}), Error);
}

double swing_of(double amplitude, double frequency) {
  OscillationDetector shaking;
  double swing = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = 1e-3 * i;
    swing =
        shaking.add(0.02 * t + amplitude * std::sin(2 * std::numbers::pi * frequency * t), 1e-3);
  }
  return swing;
}

TEST(OscillationDetector, IsTheSwingOfWhatIsFasterThanAHand) {
  EXPECT_NEAR(swing_of(1e-3, 20), 2e-3, 0.6e-3);
  EXPECT_NEAR(swing_of(1e-3, 100), 2e-3, 0.3e-3);
  EXPECT_EQ(swing_of(5e-3, 2), 0) << "a hand";
  EXPECT_EQ(swing_of(2e-5, 50), 0) << "the encoders' steps";
}

}  // namespace
}  // namespace palpate
