#include "palpate/servo/servo.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Vector3d kPressedAt(0.3e-3, 0.4e-3, -4e-3);  // m: 2 N at 500 N/m

// Steps at milliseconds, until the device is done.
std::vector<Vector3d> by_servo(Device& device, Scene& scene, const ServoOptions& options) {
  Servo servo(device, scene, options);
  std::vector<Vector3d> forces;
  for (auto state = servo.tick(); state.device == DeviceState::Status::ok; state = servo.tick()) {
    forces.push_back(state.force);
    EXPECT_EQ(state.guard.notes, GuardNote::none) << "at " << state.time << " s";
  }
  return forces;
}

// The loop that a user of the library writes.
std::vector<Vector3d> by_hand(Device& device, Scene& scene, const ServoOptions& options) {
  SceneField field(scene, options.field);
  Proxy proxy(options.proxy);
  std::vector<Vector3d> forces;
  double before = 0;
  while (true) {
    const DeviceState state = device.read();
    if (state.status != DeviceState::Status::ok) return forces;
    const bool first = forces.empty();
    const Vector3d hip = options.workspace.position_to_world(state.position);
    field.update(state.time, hip, proxy);
    const double dt = first ? 1 / device.info().rate : state.time - before;
    forces.push_back(proxy.step(field, hip, dt).force);
    device.write(options.workspace.force_to_device(forces.back()));
    before = state.time;
  }
}

TEST(Servo, GivesTheForcesOfFieldAndProxyBitForBitWhereTheGuardHasNothingToDo) {
  Scene scene;
  test::add_sheet(scene);
  ServoOptions options = test::first_links();
  options.proxy.friction = {.static_coefficient = 0.3, .dynamic_coefficient = 0.3};
  options.workspace.T_world_device.translation() = Vector3d(1e-3, 0, 2e-3);
  options.workspace.scale = 1.25;
  SimulatedDevice one({}, test::visit());
  SimulatedDevice other({}, test::visit());
  const std::vector<Vector3d> forces = by_servo(one, scene, options);
  const std::vector<Vector3d> expected = by_hand(other, scene, options);
  ASSERT_EQ(forces.size(), 1001u);
  ASSERT_EQ(forces, expected);
  EXPECT_EQ(one.true_position(), other.true_position());
  int pressed = 0;
  for (const Vector3d& force : forces) pressed += force.norm() > 0.5 ? 1 : 0;
  EXPECT_GT(pressed, 400);
}

TEST(Servo, ShowsItsLastStepToThoseWhoWatch) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  Servo servo(device, scene, test::first_links());
  EXPECT_EQ(servo.state().step, 0u);
  servo.tick(10.0);
  device.state().position = kPressedAt;
  device.state().velocity = {0, 0, -1};
  device.state().buttons = 5;
  servo.tick(10.001);
  const ServoState state = servo.state();
  EXPECT_EQ(state.step, 2u);
  EXPECT_EQ(state.time, 10.001);
  EXPECT_NEAR(state.dt, 1e-3, 1e-12);
  EXPECT_EQ(state.hip, kPressedAt);
  EXPECT_EQ(state.velocity, Vector3d(0, 0, -1));
  EXPECT_EQ(state.buttons, 5u);
  EXPECT_TRUE(state.contact.touching);
  EXPECT_NEAR(state.contact.proxy.z(), 0, 1e-4);
  EXPECT_EQ(state.force, state.contact.force);
  EXPECT_EQ(device.force(), Vector3d::Zero()) << "it renders none";
  EXPECT_GT(state.patch_points, 0u);
  EXPECT_EQ(state.field_notes, FieldNote::none);
}

TEST(Servo, AsksNoMoreOfADeviceThanItHolds) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  device.info().maximum_force = 2;
  Servo servo(device, scene, test::first_links());
  for (int i = 0; i < 100; ++i) {
    device.state().position.z() -= 1e-4;
    servo.tick(1e-3 * i);
  }
  EXPECT_NEAR(servo.state().force.norm(), 2 * Servo::kForceShare, 1e-12);
  EXPECT_EQ(device.force(), servo.state().force);
  EXPECT_NEAR(servo.state().contact.force.norm(), 2.5, 0.05);
  EXPECT_TRUE(has(servo.state().guard.notes, GuardNote::clamped));
}

TEST(Servo, DoesNotPushWhenASurfaceAppearsAroundTheHand) {
  Scene scene;
  Source& source = scene.add("sheet");
  FreeDevice device({0, 0, 1e-3});
  Servo servo(device, scene, test::pushed_out());
  for (int i = 0; i < 10; ++i) servo.tick(1e-3 * i);
  source.publish(test::still(test::plane(2e-3)));
  for (int i = 10; i < 40; ++i) {
    const ServoState& state = servo.tick(1e-3 * i);
    EXPECT_LE(state.force.norm(), 0.06);
    EXPECT_NEAR(state.contact.proxy.z(), -2.9e-3, 1e-4) << "a metaball, from below";
  }
}

TEST(Servo, LatchesWhatIsNotFiniteAndForgetsItWhenTold) {
  Scene scene;
  test::add_sheet(scene);
  for (const bool bad_time : {false, true}) {
    FreeDevice device({0, 0, 5e-3});
    Servo servo(device, scene, test::first_links());
    servo.tick(0);
    device.state().position = kPressedAt;
    EXPECT_GT(servo.tick(1e-3).force.norm(), 1);
    if (!bad_time) device.state().position.x() = kNan;
    EXPECT_EQ(servo.tick(bad_time ? kNan : 2e-3).force, Vector3d::Zero());
    EXPECT_EQ(device.force(), Vector3d::Zero());
    device.state().position = kPressedAt;
    EXPECT_EQ(servo.tick(3e-3).force, Vector3d::Zero()) << "it stays";
    EXPECT_NE(servo.state().guard.fault, Guard::Fault::none);
    device.state().position = {0, 0, 5e-3};
    servo.reset();
    servo.tick(4e-3);
    EXPECT_EQ(servo.state().guard.fault, Guard::Fault::none);
    device.state().position = kPressedAt;
    EXPECT_GT(servo.tick(5e-3).force.norm(), 1);
  }
}

TEST(Servo, SaysThatADeviceFailed) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  Servo servo(device, scene, test::first_links());
  servo.tick(0);
  device.state().position = kPressedAt;
  servo.tick(1e-3);
  device.state().status = DeviceState::Status::failed;
  EXPECT_EQ(servo.tick(2e-3).force, Vector3d::Zero());
  EXPECT_EQ(servo.state().guard.fault, Guard::Fault::device);
  EXPECT_EQ(servo.state().device, DeviceState::Status::failed);
}

TEST(Servo, SurvivesAGapAndComesBackSoftly) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  Servo servo(device, scene, test::first_links());
  servo.tick(0);
  device.state().position = kPressedAt;
  servo.tick(1e-3);
  EXPECT_EQ(servo.tick(0.101).force, Vector3d::Zero());
  EXPECT_TRUE(has(servo.state().guard.notes, GuardNote::silence));
  EXPECT_TRUE(servo.state().contact.touching) << "the contact itself goes on";
  for (int i = 1; i <= 5; ++i) {
    EXPECT_NEAR(servo.tick(0.101 + 1e-3 * i).force.norm(), 0.3 * i, 1e-6);
  }
}

TEST(Servo, WaitsAsLongForSlowDevicesAsTheyTake) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device;
  device.info().rate = 100;
  EXPECT_NEAR(Servo(device, scene).options().guard.silence, 0.025, 1e-12);
  device.info().rate = 4000;
  EXPECT_EQ(Servo(device, scene).options().guard.silence, GuardOptions().silence);
}

TEST(Servo, TakesItsFirstStepAlsoOfADeviceThatDoesNotTellItsRate) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device;
  device.info().rate = 0;
  Servo servo(device, scene, test::first_links());
  const ServoState state = servo.tick(0);
  EXPECT_EQ(state.guard.fault, Guard::Fault::none);
  EXPECT_GT(state.dt, 0);
  EXPECT_LT(state.dt, 0.01);
}

TEST(Servo, FeelsNothingWhilePaused) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  Servo servo(device, scene, test::first_links());
  servo.tick(0);
  device.state().position = kPressedAt;
  const double force = servo.tick(1e-3).force.norm();
  servo.pause(true);
  for (int i = 2; i < 10; ++i) {
    const double expected = std::max(force - 0.3 * (i - 1), 0.0);
    EXPECT_NEAR(servo.tick(1e-3 * i).force.norm(), expected, 1e-9) << "no step of force";
    EXPECT_TRUE(servo.state().paused);
  }
  servo.pause(false);
  EXPECT_NEAR(servo.tick(10e-3).force.norm(), 0.3, 1e-9);
}

TEST(Servo, ChangesWhatIsFeltWithoutAStep) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  Servo servo(device, scene, test::first_links());
  servo.tick(0);
  device.state().position = kPressedAt;
  double before = servo.tick(1e-3).force.norm();
  servo.set_contact({.stiffness = 100});
  for (int i = 2; i < 200; ++i) {
    const double force = servo.tick(1e-3 * i).force.norm();
    ASSERT_LE(force, before + 1e-12);
    ASSERT_GE(force, before - 0.3 - 1e-9);
    before = force;
  }
  EXPECT_NEAR(servo.state().contact.stiffness, 100, 1);
  EXPECT_NEAR(before, 0.4, 0.02);
}

TEST(Servo, NotesAStiffnessThatWaitsForMotion) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 15e-3});
  Servo servo(device, scene);
  servo.tick(0);
  const auto softer_at = [&](const Eigen::Vector3d& hand, double time) {
    device.state().position = hand;
    return has(servo.tick(time).contact.notes, ContactNote::softer);
  };
  EXPECT_FALSE(softer_at(kPressedAt, 1e-3));
  servo.set_contact({.stiffness = 1000});
  EXPECT_TRUE(softer_at(kPressedAt, 2e-3));
  EXPECT_TRUE(softer_at(kPressedAt, 3e-3));
  EXPECT_FALSE(softer_at({0, 0, 15e-3}, 4e-3)) << "in the air";
  EXPECT_FALSE(softer_at(kPressedAt, 5e-3));
  EXPECT_EQ(servo.state().contact.stiffness, 1000);
  servo.set_contact({.stiffness = 100});
  EXPECT_FALSE(softer_at(kPressedAt, 6e-3)) << "it is stiffer";
}

TEST(Servo, ChangesTheSurfaceWithoutPushingAndLetsItsForceFade) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 15e-3});
  Servo servo(device, scene, test::first_links());
  servo.tick(0);
  device.state().position = {0, 0, 2e-3};
  EXPECT_EQ(servo.tick(1e-3).force.norm(), 0) << "above the sheet";
  EXPECT_EQ(servo.field().kind, FieldOptions::Kind::balanced);
  servo.set_field({.kind = FieldOptions::Kind::metaball});  // 0.49 R = 4.9 mm before its points
  EXPECT_EQ(servo.field().kind, FieldOptions::Kind::metaball);
  for (int i = 2; i < 100; ++i) EXPECT_LE(servo.tick(1e-3 * i).force.norm(), 0.06);
  EXPECT_NEAR(servo.state().contact.proxy.z(), 4.9e-3, 2e-4);
  const auto go_to = [&](double z, int tick) {
    device.state().position.z() = z;
    return servo.tick(1e-3 * tick).force.norm();
  };
  go_to(10e-3, 100);
  double before = go_to(2e-3, 101);
  for (int i = 102; i < 200; ++i) before = go_to(2e-3, i);
  EXPECT_NEAR(before, 500 * 2.9e-3, 0.1) << "pressed into what stands there, it is firm";
  servo.set_field({});
  EXPECT_LE(before - go_to(2e-3, 200), 0.3 + 1e-9);
  for (int i = 201; i < 500; ++i) before = go_to(2e-3, i);
  EXPECT_EQ(before, 0);
}

TEST(Servo, RefusesWhatCannotBeFelt) {
  Scene scene;
  FreeDevice device;
  Servo servo(device, scene, test::first_links());
  EXPECT_THROW(servo.set_field({.threshold = -1}), Error);
  EXPECT_THROW(servo.set_contact({.texture = {.amplitude = kNan}}), Error);
  EXPECT_THROW(servo.set_contact({.stiffness = -1}), Error);
  EXPECT_THROW(servo.set_contact({.stiffness = kNan}), Error);
  EXPECT_THROW(servo.set_contact({.friction = {.dynamic_coefficient = 1}}), Error);
  EXPECT_THROW(Servo(device, scene, {.guard = {.slew = -1}}), Error);
}

}  // namespace
}  // namespace palpate
