// The driver of Force Dimension's devices, against a library with the maker's names (fake_dhd.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "device/double_library.hpp"
#include "device/drivers.hpp"
#include "device/fault_trial.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/device.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

const std::string kLibrary = PALPATE_FAKE_DHD;
const std::string kName = "forcedimension:0,library=" + kLibrary;
const Vector3d kForce(1, 2, 3);
const SteadyClock kClock;

std::unique_ptr<DeviceDriver> open(const std::string& name = kName) {
  return device::open_forcedimension(device::parse_device_name(name), kClock);
}

std::string refused_dhd(const std::string& name = kName) {
  try {
    (void)open(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

class ForceDimension : public testing::Test {
 protected:
  ForceDimension() { double_.reset(); }

  void advance(double time) const { double_.find<void(double)>("fake_advance")(time); }

  test::DoubleLibrary double_{kLibrary};
};

TEST_F(ForceDimension, TellsPlacesAndForcesAsTheOperatorSits) {
  double_.place(0.01, 0.02, 0.03);
  const auto link = open();
  const DeviceState reading = link->exchange(kForce);
  EXPECT_EQ(reading.position, Vector3d(0.02, -0.01, 0.03));
  EXPECT_EQ(double_.force(), Vector3d(-2, 1, 3));
  EXPECT_EQ(reading.buttons, 5u);
}

TEST_F(ForceDimension, TellsHowItsToolIsHeldWhereItHasAWrist) {
  EXPECT_FALSE(open()->info().has_orientation);
  EXPECT_TRUE(open()->exchange(kForce).orientation.isApprox(Eigen::Quaterniond::Identity(), 0));
  // The maker's x is towards the operator: its tip lifted is a turn about the maker's y, which is
  // our x.
  const double lifted = 0.3;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(lifted, Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d rows = turn.transpose();  // columns are kept one after the other
  double_.find<void(const double*)>("fake_frame")(rows.data());
  const auto link = open();
  EXPECT_TRUE(link->info().has_orientation);
  const Eigen::Quaterniond told = link->exchange(kForce).orientation;
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(lifted, Vector3d::UnitX()));
  EXPECT_LT(told.angularDistance(expected), 1e-12);
  EXPECT_NEAR(told.norm(), 1, 1e-12);
  EXPECT_NEAR((told * Vector3d::UnitY()).z(), std::sin(lifted), 1e-12) << "the tip points up";
}

TEST_F(ForceDimension, TellsTheOpeningOfAGripper) {
  EXPECT_FALSE(open()->info().has_gripper);
  EXPECT_EQ(open()->exchange(kForce).gripper, 0);
  double_.find<void(double)>("fake_gap")(0.012);
  const auto link = open();
  EXPECT_TRUE(link->info().has_gripper);
  EXPECT_EQ(link->exchange(kForce).gripper, 0.012);
}

TEST_F(ForceDimension, GivesTorqueAndGripToMotorsThatAreThere) {
  double_.find<void(const double*)>("fake_frame")(Eigen::Matrix3d::Identity().eval().data());
  double_.find<void(double)>("fake_gap")(0.012);
  EXPECT_EQ(open()->info().maximum_torque, 0) << "a wrist that is measured alone";
  EXPECT_EQ(open()->info().maximum_grip, 0);
  double_.flag("fake_motors", true);
  double_.find<void(const char*)>("fake_name")("sigma.7");
  auto link = open();
  EXPECT_EQ(link->info().maximum_torque, *device_profile("sigma").maximum_torque);
  EXPECT_EQ(link->info().maximum_grip, *device_profile("sigma").maximum_grip);
  DeviceState reading = link->exchange_wrench({kForce, {0.1, 0.2, 0.3}, -4});
  EXPECT_EQ(reading.angular_velocity, Vector3d::Zero()) << "its window is not full yet";
  Vector3d torque;
  double_.find<void(double*)>("fake_torque")(torque.data());
  EXPECT_EQ(torque, Vector3d(-0.2, 0.1, 0.3));
  EXPECT_EQ(double_.find<double()>("fake_grip")(), -4);
  EXPECT_EQ(double_.force(), Vector3d(-2, 1, 3));
  for (int i = 0; i < 3; ++i) reading = link->exchange(kForce);
  EXPECT_EQ(reading.angular_velocity, Vector3d(2, -1, 3));
  double_.find<void(double*)>("fake_torque")(torque.data());
  EXPECT_EQ(torque, Vector3d::Zero()) << "a force alone lets it go";
  double_.find<void(const char*)>("fake_name")("prototype");
  EXPECT_EQ(open()->info().maximum_torque, *device_profile("unknown").maximum_torque);
}

TEST_F(ForceDimension, AForceMovesTheHandItsWay) {
  const auto link = open();
  const Vector3d push(0.3, -0.6, 0.2);
  DeviceState reading;
  for (int i = 0; i < 4000; ++i) {
    reading = link->exchange(push);
    advance(0.25e-3);
  }
  EXPECT_NEAR(reading.position.normalized().dot(push.normalized()), 1, 1e-9);
  EXPECT_NEAR(reading.velocity.normalized().dot(push.normalized()), 1, 1e-9);
  EXPECT_NEAR(reading.velocity.norm(), push.norm() / 2, 2e-3) << "against 2 N s/m";
}

TEST_F(ForceDimension, IsWhatItsNameTellsOrTheProfileThatIsGiven) {
  const DeviceInfo omega = open()->info();
  EXPECT_THAT(omega.name, AllOf(HasSubstr("forcedimension:0"), HasSubstr("omega.3")));
  EXPECT_EQ(omega.maximum_force, *device_profile("omega").maximum_force);
  EXPECT_EQ(omega.maximum_stiffness, *device_profile("omega").maximum_stiffness);
  EXPECT_EQ(open(kName + ",profile=falcon")->info().maximum_force,
            *device_profile("falcon").maximum_force);
  double_.find<void(const char*)>("fake_name")("prototype");
  EXPECT_EQ(open()->info().maximum_force, *device_profile("unknown").maximum_force);
}

TEST_F(ForceDimension, ArmsTheWatchdogAndLeavesTheVelocityThresholdAlone) {
  const auto link = open();
  EXPECT_DOUBLE_EQ(double_.find<double()>("fake_watchdog_time")(), 5e-3);
  EXPECT_EQ(double_.find<int()>("fake_threshold_changes")(), 0);
  (void)link->exchange(kForce);
  advance(4.9e-3);
  EXPECT_GT(double_.force().norm(), 3);
  advance(0.2e-3);
  EXPECT_EQ(double_.force().norm(), 0);
}

TEST_F(ForceDimension, SaysWhereThereIsNoWatchdog) {
  double_.flag("fake_watchdog", false);
  EXPECT_THAT(open()->info().name, HasSubstr("without a watchdog"));
}

TEST_F(ForceDimension, EndsWithoutAForceAndCloses) {
  auto link = open();
  (void)link->exchange(kForce);
  ASSERT_TRUE(double_.is_open());
  link.reset();
  EXPECT_EQ(double_.force().norm(), 0);
  EXPECT_FALSE(double_.is_open());
}

TEST_F(ForceDimension, SaysWhyThereIsNone) {
  EXPECT_THAT(refused_dhd("forcedimension,library=/none/libdhd.so.3"),
              AllOf(HasSubstr("/none/libdhd.so.3"), HasSubstr("forcedimension.com"),
                    HasSubstr("palpate doctor")));
  EXPECT_THAT(refused_dhd("forcedimension,library=libdl.so.2"), HasSubstr("dhd"));
  EXPECT_THAT(refused_dhd("forcedimension:1,library=" + kLibrary), HasSubstr("1 found"));
  EXPECT_THAT(refused_dhd("forcedimension:x,library=" + kLibrary), HasSubstr("number"));
  EXPECT_THAT(refused_dhd(kName + ",profile=omego"), HasSubstr("omego"));
  EXPECT_FALSE(double_.is_open());
  double_.flag("fake_busy", true);
  EXPECT_THAT(refused_dhd(), AllOf(HasSubstr("in use"), HasSubstr("other programs")));
  double_.flag("fake_busy", false);
  double_.flag("fake_calibrated", false);
  EXPECT_THAT(refused_dhd(), HasSubstr("not calibrated"));
  EXPECT_FALSE(double_.is_open());
  double_.flag("fake_plug", false);
  EXPECT_THAT(refused_dhd(), AllOf(HasSubstr("0 found"), HasSubstr("Plug it in")));
}

// What each fault does to the force, in simulated time.
class ForceDimensionFaults : public ForceDimension {
 protected:
  ForceDimensionFaults() {
    trial_.run(0.05);
    EXPECT_TRUE(trial_.is_pushed());
  }

  void expect_lost(const char* fault, bool value, const char* word) {
    trial_.expect_lost(
        fault, [&](bool on) { double_.flag(fault, on == value); }, word);
  }

  test::MovedClock clock_;
  test::FaultTrial trial_{{.open = [] { return open(); },
                           .advance = [this](double time) { advance(time); },
                           .force = [this] { return double_.force().norm(); },
                           .period = 0.25e-3},
                          clock_,
                          kForce};
};

TEST_F(ForceDimensionFaults, TakeTheForceAwayInTimeAndAreToldOnce) {
  expect_lost("fake_plug", false, "cable");
  expect_lost("fake_failing", true, "communication error");
  expect_lost("fake_not_a_number", true, "not a number");
  trial_.expect_lost(
      "leap", [&](bool) { double_.place(0, 0.5, 0); }, "jumped by");
}

TEST_F(ForceDimensionFaults, AThreadThatHangsIsTheWatchdogs) {
  const double start = clock_.now();
  trial_.run(0.1, false);
  EXPECT_LE(trial_.pushed() - start, 6e-3);
  trial_.forget();
  trial_.run(0.1);
  EXPECT_TRUE(trial_.is_free()) << "its forces are off";
  EXPECT_THAT(*trial_.reasons().rbegin(), HasSubstr("watchdog"));
  trial_.run(1.2);
  EXPECT_TRUE(trial_.is_pushed()) << "and come back when it is opened again";
}

}  // namespace
}  // namespace palpate
