// The driver of 3D Systems' devices, against a library with the maker's names (fake_hd.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>

#include "device/fault_trial.hpp"
#include "device/openhaptics_rig.hpp"
#include "palpate/device/device.hpp"

namespace palpate {
namespace {

using device::OpenHapticsDriver;
using Eigen::Vector3d;
using test::FakeHd;
using test::kDouble;
using test::kPush;
using test::kTouch;
using testing::AllOf;
using testing::HasSubstr;

class OpenHaptics : public test::OpenHapticsRig {};

TEST_F(OpenHaptics, TellsPlacesAndForcesAsTheOperatorSits) {
  const auto link = open();
  library_.place(10, 20, 30);
  const DeviceState reading = link->exchange(kPush);
  EXPECT_TRUE(reading.position.isApprox(Vector3d(0.01, -0.03, 0.02), 1e-12));
  EXPECT_EQ(library_.force(), Vector3d(0.2, 0.6, -0.4));
  EXPECT_EQ(reading.buttons, 2u);
}

TEST_F(OpenHaptics, TellsHowItsStylusIsHeldAndHowFastItTurns) {
  const auto link = open();
  EXPECT_TRUE(link->info().has_orientation);
  EXPECT_TRUE(link->exchange(kPush).orientation.isApprox(Eigen::Quaterniond::Identity(), 1e-12));
  set(&FakeHd::turned, 0.3);  // about the maker's y, which is our z
  const DeviceState reading = link->exchange(kPush);
  EXPECT_NEAR(reading.orientation.angularDistance(
                  Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vector3d::UnitZ()))),
              0, 1e-12);
  EXPECT_NEAR(reading.angular_velocity.z(), 300, 1e-9) << "in a frame of a millisecond";
  EXPECT_EQ(link->exchange(kPush).angular_velocity.norm(), 0);
}

TEST_F(OpenHaptics, GivesTorqueToAPhantomOfSixMotorsAlone) {
  const auto torque = [this] {
    Vector3d told;
    library_.find<void(double*)>("fake_torque")(told.data());
    return told;
  };
  const Wrench wrench{kPush, {0.1, 0.2, 0.3}, 0};
  set(&FakeHd::continuous_torque, 188.0);
  auto link = open();
  EXPECT_EQ(link->info().maximum_torque, 0) << "a Touch has no motors for it";
  (void)link->exchange_wrench(wrench);
  EXPECT_EQ(torque(), Vector3d::Zero());
  link.reset();
  set(&FakeHd::model, std::array<char, 32>{"PHANTOM Premium 1.5 6DOF"});
  link = open();
  EXPECT_DOUBLE_EQ(link->info().maximum_torque, 0.188);
  (void)link->exchange_wrench(wrench);
  EXPECT_LT((torque() - Vector3d(100, 300, -200)).norm(), 1e-9);
  EXPECT_EQ(library_.force(), Vector3d(0.2, 0.6, -0.4));
  pass(6e-3);
  tick(1);
  EXPECT_EQ(torque(), Vector3d::Zero()) << "nobody spoke";
}

TEST_F(OpenHaptics, AForceMovesTheHandItsWay) {
  const auto link = open();
  DeviceState reading;
  for (int i = 0; i < 1000; ++i) reading = link->exchange(kPush);
  EXPECT_NEAR(reading.position.normalized().dot(kPush.normalized()), 1, 1e-9);
  EXPECT_NEAR(reading.velocity.normalized().dot(kPush.normalized()), 1, 1e-9);
  EXPECT_NEAR(reading.velocity.norm(), kPush.norm() / 2, 2e-3) << "against 2 N s/m";
}

TEST_F(OpenHaptics, IsWhatItTellsOrTheProfileThatIsGiven) {
  const auto tells = [this](std::array<char, 32> model, double force, double stiffness) {
    hardware_.model = model;
    hardware_.continuous_force = force;
    hardware_.stiffness = stiffness;
    set();
  };
  const DeviceInfo touch = open()->info();
  EXPECT_EQ(touch.name, "openhaptics:Default Device (Touch)");
  EXPECT_EQ(touch.maximum_force, 0.88);
  EXPECT_DOUBLE_EQ(touch.maximum_stiffness, 400);
  EXPECT_EQ(touch.workspace_radius, *device_profile("touch").workspace_radius);
  EXPECT_EQ(open(kTouch + ",profile=omega")->info().maximum_force,
            *device_profile("omega").maximum_force);
  tells({"PHANTOM Premium 1.5"}, 1.4, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(open()->info().maximum_force, 1.4);
  EXPECT_EQ(open()->info().maximum_stiffness,
            *device_profile("phantom-premium-1.5").maximum_stiffness);
  tells({"Touch X"}, 0, 0);
  EXPECT_EQ(open()->info().maximum_stiffness, *device_profile("touch-x").maximum_stiffness);
  tells({"prototype"}, 0, 0);
  EXPECT_EQ(open()->info().maximum_force, *device_profile("unknown").maximum_force);
}

TEST_F(OpenHaptics, AForceLastsFiveMillisecondsWhereNobodySpeaks) {
  const auto link = open();
  (void)link->exchange(kPush);
  pass(4.9e-3);
  tick(1);
  EXPECT_GT(library_.force().norm(), 0.7);
  pass(0.2e-3);
  tick(1);
  EXPECT_EQ(library_.force().norm(), 0);
}

TEST_F(OpenHaptics, AFrameThatHangsAppliesNoOldForce) {
  const auto link = open();
  (void)link->exchange(kPush);
  set(&FakeHd::hangs, true);
  link->link().request({.force = kPush});
  tick(1);  // until it hangs
  pass(0.1);
  set(&FakeHd::hangs, false);
  (void)link->link().answer();
  EXPECT_EQ(library_.force().norm(), 0);
  (void)link->exchange(kPush);
  EXPECT_GT(library_.force().norm(), 0.7);
}

TEST_F(OpenHaptics, EndsWithoutAForceAndStopsTheSchedulerWithTheLast) {
  auto other = std::make_unique<OpenHapticsDriver>(
      device::parse_device_name("openhaptics:Other,library=" + kDouble), clock_);
  auto link = open();
  (void)link->exchange(kPush);
  ASSERT_TRUE(library_.is_open());
  library_.flag("fake_by_itself", true);
  link.reset();
  EXPECT_EQ(library_.force().norm(), 0);
  EXPECT_FALSE(library_.is_open());
  EXPECT_TRUE(runs());
  (void)other->exchange(kPush);
  other.reset();
  EXPECT_FALSE(runs());
}

TEST_F(OpenHaptics, SaysWhyThereIsNone) {
  EXPECT_THAT(
      refusal("openhaptics,library=/none/libHD.so"),
      AllOf(HasSubstr("/none/libHD.so"), HasSubstr("3D Systems"), HasSubstr("palpate doctor")));
  EXPECT_THAT(refusal("openhaptics,library=libdl.so.2"), HasSubstr("hdInitDevice"));
  EXPECT_THAT(refusal("openhaptics:Left,library=" + kDouble),
              AllOf(HasSubstr("openhaptics:Left"), HasSubstr("0x0303"), HasSubstr("Touch_Setup")));
  EXPECT_THAT(refusal(kTouch + ",profile=tuch"), HasSubstr("tuch"));
  EXPECT_FALSE(library_.is_open());
  set(&FakeHd::busy, true);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("ALREADY"), HasSubstr("other programs")));
  set(&FakeHd::busy, false);
  set(&FakeHd::temperature, 0.6);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("0.60"), HasSubstr("cool down")));
  set(&FakeHd::temperature, 0.1);
  set(&FakeHd::failing, 0x0300);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("HD_DEVICE_FAULT"), HasSubstr("cable")));
  set(&FakeHd::failing, 0);
  set(&FakeHd::plugged, false);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("HD_COMM_ERROR"), HasSubstr("Plug it in")));
  EXPECT_FALSE(library_.is_open());
  EXPECT_FALSE(runs());
}

TEST_F(OpenHaptics, IsCalibratedByItselfIfItCanBe) {
  set(&FakeHd::calibration, 0x5002);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("not calibrated"), HasSubstr("inkwell")));
  hardware_.styles = 1;  // in a place that its encoders are reset in
  set(&FakeHd::calibration, 0x5001);
  EXPECT_THAT(refusal(), HasSubstr("not calibrated"));
  EXPECT_FALSE(library_.is_open());
  set(&FakeHd::styles, 4);
  EXPECT_EQ(refusal(), "no error");
}

// What each fault does to the force, in simulated time.
class OpenHapticsFaults : public OpenHaptics {
 protected:
  OpenHapticsFaults() {
    trial_.run(0.05);
    EXPECT_TRUE(trial_.is_pushed());
  }

  void expect_failure(unsigned code, const char* word) {
    trial_.expect_lost(
        word, [&](bool on) { set(&FakeHd::failing, on ? code : 0); }, word);
  }

  test::FaultTrial trial_{{.open = [this] { return open(); },
                           .advance = [this](double) { tick(1); },
                           .force = [this] { return library_.force().norm(); }},
                          clock_,
                          kPush};
};

TEST_F(OpenHapticsFaults, TakeTheForceAwayInTimeAndAreToldOnce) {
  trial_.expect_lost(
      "unplugged", [&](bool on) { set(&FakeHd::plugged, !on); }, "cable");
  expect_failure(0x0302, "HD_COMM_ERROR");
  expect_failure(0x0300, "HD_DEVICE_FAULT");
  expect_failure(0x0201, "too large a force");
  expect_failure(0x0203, "too fast");
  expect_failure(0x0304, "in time");
  expect_failure(0x0600, "0x0600");
  trial_.expect_lost(
      "no number", [&](bool on) { set(&FakeHd::not_a_number, on); }, "not a number");
  trial_.expect_lost(
      "leap", [&](bool) { library_.place(0, 0, 500); }, "jumped by");
  trial_.expect_lost(
      "lost calibration", [&](bool on) { set(&FakeHd::calibration, on ? 0x5002 : 0x5000); },
      "inkwell");
}

TEST_F(OpenHapticsFaults, MotorsCoolDownBeforeItIsOpenedAgain) {
  set(&FakeHd::failing, 0x0200);
  set(&FakeHd::temperature, 0.9);
  trial_.run(0.1);
  EXPECT_THAT(trial_.reasons(), testing::Contains(HasSubstr("too hot")));
  set(&FakeHd::failing, 0);
  trial_.run(2.5);
  EXPECT_TRUE(trial_.is_free()) << "they are still warm";
  set(&FakeHd::temperature, 0.3);
  trial_.run(1.2);
  EXPECT_TRUE(trial_.is_pushed());
}

TEST_F(OpenHapticsFaults, AThreadThatHangsIsTheFrames) {
  const double start = clock_.now();
  trial_.run(0.1, false);
  EXPECT_LE(trial_.pushed() - start, 6e-3);
  trial_.run(0.05);
  EXPECT_TRUE(trial_.is_pushed()) << "it goes on with the thread";
  EXPECT_EQ(trial_.reopened(), 0);
}

TEST_F(OpenHapticsFaults, ASchedulerThatHangsIsGivenUpAndComesBack) {
  set(&FakeHd::hangs, true);
  trial_.forget();
  trial_.run(0.1);
  EXPECT_TRUE(trial_.is_free());
  EXPECT_THAT(trial_.reasons(), testing::ElementsAre(HasSubstr("is not running")));
  EXPECT_EQ(trial_.reopened(), 0);
  trial_.run(1.2);
  EXPECT_EQ(trial_.reopened(), 1);
  EXPECT_TRUE(trial_.is_pushed());
}

// With the thread of ThreadedDevice and the scheduler's, in real time; no deadline.
TEST_F(OpenHaptics, ThreadsExchangeWithoutARace) {
  SteadyClock clock;
  ThreadedDevice device(
      [&clock] {
        return std::make_unique<OpenHapticsDriver>(device::parse_device_name(kTouch), clock);
      },
      clock);
  int felt = 0;
  for (int i = 0; i < 5000 && felt < 50; ++i) {
    const DeviceState state = device.read();
    device.write(state.status == DeviceState::Status::ok ? kPush : Vector3d::Zero().eval());
    if (library_.force().norm() > 0.7) ++felt;
    clock.wait_until(clock.now() + 1e-3);
  }
  EXPECT_EQ(felt, 50);
  EXPECT_GT(device.read().position.norm(), 0);
}

}  // namespace
}  // namespace palpate
