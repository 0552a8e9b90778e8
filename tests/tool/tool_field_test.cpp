// Checks tools on clouds and streams: a field for each group of samples.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "tool/held_tool.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

TEST(ToolField, ABoxRestsOnASheet) {
  Scene scene;
  scene.add("sheet", cloud_of(sheet({}, 0.06)));
  HeldTool held(scene, Tool::box({0.04, 0.06, 0.02}, 0.004));
  held.reset(pose_at({0, 0, 0.03}));
  const ToolContact contact = held.to(pose_at({0, 0, 0.007}));
  EXPECT_NEAR(contact.wrench.force.z(), 1.5, 1e-3);
  EXPECT_LT(contact.wrench.force.head<2>().norm(), 1e-3);
  EXPECT_LT(contact.wrench.torque.norm(), 1e-4);
  EXPECT_LT(held.depth(), 0.01);
  EXPECT_GT(held.field().groups(), 4);
  EXPECT_EQ(held.field().notes(), FieldNote::none);
}

// Samples far denser than points, and far sparser than R: all four corners of a flat face are
// there.
TEST(ToolField, ABoxRestsWhateverItsSpacing) {
  Scene scene;
  scene.add("sheet", cloud_of(sheet({}, 0.06)));
  for (const double spacing : {2e-3, 0.02, 0.06}) {
    HeldTool held(scene, Tool::box({0.04, 0.06, 0.02}, spacing));
    held.reset(pose_at({0, 0, 0.03}));
    const ToolContact contact = held.to(pose_at({0, 0, 0.007}));
    EXPECT_NEAR(contact.wrench.force.z(), 1.5, 1e-3) << spacing;
    EXPECT_LT(contact.wrench.force.head<2>().norm(), 1e-3) << spacing;
    EXPECT_LT(contact.wrench.torque.norm(), 1e-3) << spacing;
  }
}

// Each source knows a half of the sheet, and a little more: the box lies across the seam.
TEST(ToolField, ABoxRestsOnTwoSources) {
  const Eigen::Isometry3d flat = Eigen::Isometry3d::Identity();
  Scene scene;
  scene.add("left", cloud_of(sheet({}, {-0.06, -0.06}, {0.004, 0.06}, flat)));
  scene.add("right", cloud_of(sheet({}, {-0.004, -0.06}, {0.06, 0.06}, flat)));
  HeldTool held(scene, Tool::box({0.04, 0.06, 0.02}, 0.004));
  held.reset(pose_at({0, 0, 0.03}));
  const ToolContact contact = held.to(pose_at({0, 0, 0.007}));
  EXPECT_NEAR(contact.wrench.force.z(), 1.5, 1e-2);
  EXPECT_LT(contact.wrench.torque.norm(), 1e-3);
  double step = 0;
  Vector3d last = contact.wrench.force;
  for (int i = 0; i < 400; ++i) {  // and slides from one to the other
    const ToolContact now = held.to(pose_at({5e-5 * i, 0, 0.007}), 1, 0);
    step = std::max(step, (now.wrench.force - last).norm());
    last = now.wrench.force;
  }
  EXPECT_NEAR(last.z(), 1.5, 1e-2);
  EXPECT_LT(step, 0.02);
}

// The stylus is held at 30 degrees, and its tip alone touches, 40 mm from the handle.
TEST(ToolField, ALeverTurnsTheHand) {
  Scene scene;
  scene.add("sheet", cloud_of(sheet({}, 0.06)));
  HeldTool held(scene, Tool::capsule(0.04, 1e-3, 2e-3));
  const Vector3d tilt(0, -std::numbers::pi / 3, 0);  // the tip is 20 mm below the handle, along x
  held.reset(pose_at({-0.02, 0, 0.04}, tilt));
  const ToolContact contact = held.to(pose_at({-0.02, 0, 0.018}, tilt), 200, 600);
  EXPECT_EQ(contact.touch_count, 1);
  // The tip's center is a radius above the sheet; with the lever l along x and the stiffness K g^2
  // of turns the handle rises by z and turns by t: z + l t = 3 mm, z = l t (g / l)^2.
  const double lever = 0.04 * std::sin(std::numbers::pi / 3);
  const Vector3d& force = contact.wrench.force;
  EXPECT_NEAR(contact.wrench.torque.y(), -lever * force.z(), 0.05 * lever * force.z());
  const double share = kGyration * kGyration / (kGyration * kGyration + lever * lever);
  EXPECT_NEAR(force.z(), kStiffness * 3e-3 * share, 0.05 * kStiffness * 3e-3 * share);
}

// Fingers on both sides of an open sheet each keep theirs.
TEST(ToolField, FingersPinchAnOpenSheet) {
  Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  upright.rotate(Eigen::AngleAxisd(std::acos(-1) / 2, Vector3d::UnitY()));
  Scene scene;
  scene.add("sheet", cloud_of(sheet({}, {-0.04, -0.04}, {0.04, 0.04}, upright)));
  HeldTool held(scene, Tool::gripper({0.006, 0.012, 0.03}, 0.004));
  held.reset(pose_at({2e-3, 0, 0.10}, Vector3d::Zero(), 0.02));
  held.to(pose_at({2e-3, 0, 0.04}, Vector3d::Zero(), 0.02), 600, 0);
  const ToolContact contact = held.to(pose_at({2e-3, 0, 0.04}), 200, 2000);
  // argmin (x - 2 mm)^2 + o^2 where x <= o / 2: both in mm, x = 0.4, o = 0.8.
  EXPECT_NEAR(held.pose().position.x(), 0.4e-3, 2e-5);
  EXPECT_NEAR(held.pose().opening, 0.8e-3, 4e-5);
  EXPECT_NEAR(contact.wrench.force.x(), -500 * 1.6e-3, 1e-2);
  EXPECT_NEAR(contact.wrench.grip, 500 * 0.8e-3, 2e-2);
}

// A plate of 8 mm between the fingers.
TEST(ToolField, FingersHoldAPlate) {
  Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  upright.rotate(Eigen::AngleAxisd(std::acos(-1) / 2, Vector3d::UnitY()));
  upright.pretranslate(Vector3d(4e-3, 0, 0));
  std::vector<TestPoint> points = sheet({}, {-0.04, -0.04}, {0.04, 0.04}, upright);
  upright.pretranslate(Vector3d(-8e-3, 0, 0));
  for (TestPoint p : sheet({}, {-0.04, -0.04}, {0.04, 0.04}, upright)) {
    p.normal = -p.normal;
    points.push_back(p);
  }
  Scene scene;
  scene.add("plate", cloud_of(points, true));
  HeldTool held(scene, Tool::gripper({0.006, 0.012, 0.03}, 0.004));
  held.reset(pose_at({0, 0, 0.10}, Vector3d::Zero(), 0.03));
  held.to(pose_at({0, 0, 0.04}, Vector3d::Zero(), 0.03), 600, 0);
  const ToolContact contact = held.to(pose_at({0, 0, 0.04}, Vector3d::Zero(), 0.004), 200, 500);
  EXPECT_NEAR(held.pose().opening, 8e-3, 1e-4);
  EXPECT_NEAR(contact.wrench.grip, 2, 0.05);
}

// A box between two sheets of one cloud, which face alike: above the one and below the other.
TEST(ToolField, ABoxGoesBetweenTwoSheets) {
  std::vector<TestPoint> points = sheet({.spacing = 3e-3}, 0.03);
  const std::vector<TestPoint> upper = sheet({.spacing = 3e-3}, 0.03, 0.02);
  points.insert(points.end(), upper.begin(), upper.end());
  Scene scene;
  scene.add("sheets", cloud_of(points));
  HeldTool held(scene, Tool::box({0.02, 0.02, 0.016}, 2e-3));
  held.reset(pose_at({0.06, 0, 0.01}));
  held.to(pose_at({0, 0, 0.01}), 1200, 300);
  EXPECT_NEAR(held.to(pose_at({0, 0, 0.006})).wrench.force.z(), 1, 5e-3);
  EXPECT_NEAR(held.to(pose_at({0, 0, 0.014})).wrench.force.z(), -1, 5e-3);
}

// One point and no radius is the proxy of three degrees of freedom.
TEST(ToolField, APointIsTheProxyOfAPoint) {
  Scene scene;
  scene.add("ball", cloud_of(ball({.jitter = 0.2}, 0.04)));
  HeldTool held(scene, Tool({Tool::Point{}}), {.stiffness = 500});
  SceneField field(scene);
  Proxy proxy({.stiffness = 500, .friction = {}});
  const auto hand_at = [](int i) {
    const double t = 1e-3 * i;
    return Vector3d((0.045 + 0.01 * std::cos(5 * t)) *
                    Vector3d(std::sin(2 * t), std::sin(3 * t) * std::cos(2 * t), std::cos(2 * t)));
  };
  held.reset(pose_at(hand_at(0)));
  proxy.reset(hand_at(0));
  std::vector<double> differences;
  int touching = 0;
  for (int i = 0; i < 4000; ++i) {
    field.update(1e-3 * i, hand_at(i), proxy);
    const Contact contact = proxy.step(field, hand_at(i), kTick);
    const ToolContact tool = held.step(pose_at(hand_at(i)));
    differences.push_back((contact.force - tool.wrench.force).norm());
    touching += contact.touching ? 1 : 0;
  }
  std::ranges::sort(differences);
  EXPECT_GT(touching, 600);
  EXPECT_LT(differences[2000], 1e-4);
  EXPECT_LT(differences[3960], 0.02);
  EXPECT_LT(differences.back(), 0.3);
}

TEST(ToolField, ToolsOfOthersAreAFault) {
  Scene scene;
  const ToolField field(scene, std::make_shared<const Tool>(Tool::ball(0.01)));
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 5e-3));
  EXPECT_TRUE(has(proxy.step(field, pose_at({0, 0, 0}), kTick).notes, ContactNote::fault));
}

TEST(ToolField, RefusesWhatIsForAPointAlone) {
  Scene scene;
  const auto tool = std::make_shared<const Tool>(Tool::ball(0.01));
  EXPECT_THROW(ToolField(scene, nullptr), Error);
  EXPECT_THROW(ToolField(scene, tool, {.tool_radius = 1e-3}), Error);
  EXPECT_THROW(ToolField(scene, tool, {.nearest_radius = true}), Error);
}

TEST(ToolField, NothingIsFreeAndUnknownWithoutASurface) {
  Scene scene;
  HeldTool held(scene, Tool::box({0.02, 0.03, 0.01}, 0.005));
  held.reset(pose_at({0, 0, 0.1}));
  const ToolContact contact = held.to(pose_at({0, 0, -0.1}));
  EXPECT_FALSE(contact.touching);
  EXPECT_NEAR(held.pose().position.z(), -0.1, 1e-12);
  EXPECT_TRUE(has(held.field().notes(), FieldNote::no_surface));
}

}  // namespace
}  // namespace palpate::test
