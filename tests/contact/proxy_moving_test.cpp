// Surfaces that step, vanish or cannot be found (docs/method.md 3.4).
#include <gtest/gtest.h>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const Vector3d kHip(0.004, 0, -0.003);

void put_at(PlaneField& plane, double height) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Vector3d(0, 0, height));
  plane.set_pose(pose);
}

Proxy pressed(const Field& field) {
  Proxy proxy;
  proxy.reset({0.004, 0, 0.03});
  drive(proxy, field, {0.004, 0, 0.03}, kHip, 0.1);
  return proxy;
}

class Step : public testing::TestWithParam<double> {};

TEST_P(Step, PlaneTakesTheProxyAlongInOneStep) {
  const double dz = GetParam();
  PlaneField plane({.reanchor_reach = 0.02});
  Proxy proxy = pressed(plane);
  put_at(plane, dz);
  const Contact c = proxy.step(plane, kHip, kTick);
  EXPECT_NEAR(c.force.z(), std::max(0.0, 500 * (dz - kHip.z())), 1e-6);
}

TEST_P(Step, ThinSheetTakesTheProxyAlongInOneStep) {
  const double dz = GetParam();
  SheetField sheet;
  sheet.reach = 0.02;
  Proxy proxy = pressed(sheet);
  sheet.height = dz;
  ++sheet.revision;
  const Contact c = proxy.step(sheet, kHip, kTick);
  EXPECT_NEAR(c.force.z(), std::max(0.0, 500 * (dz - kHip.z())), 1e-6);
  EXPECT_EQ(c.touching, dz >= kHip.z());
}

INSTANTIATE_TEST_SUITE_P(Millimetres, Step,
                         testing::Values(0.5e-3, 1e-3, 2e-3, 4e-3, 6e-3, 10e-3, 15e-3, -0.5e-3,
                                         -1e-3, -2e-3, -4e-3, -6e-3, -10e-3, -15e-3));

TEST(Moving, SheetThatStepsFartherThanTheReachIsNotGrabbed) {
  SheetField sheet;
  Proxy proxy = pressed(sheet);
  sheet.height = 0.015;
  ++sheet.revision;
  EXPECT_FALSE(proxy.step(sheet, kHip, kTick).touching);
  EXPECT_EQ(rest(proxy, sheet, kHip, 200).force.norm(), 0);
}

TEST(Moving, SlowSurfaceNeedsNoReanchoring) {
  PlaneField plane;
  Proxy proxy = pressed(plane);
  for (int i = 0; i < 100; ++i) {
    put_at(plane, 5e-6 * i);
    const Contact c = proxy.step(plane, kHip, kTick);
    EXPECT_FALSE(has(c.notes, ContactNote::reanchored));
    EXPECT_NEAR(c.force.z(), 500 * (5e-6 * i + 0.003), 1e-6);
  }
}

// A plane goes from under a proxy that is free to 3 mm above it.
Contact passed_by(PlaneField plane) {
  const Vector3d hand(0, 0, 0.001);
  Proxy proxy;
  proxy.reset(hand);
  (void)proxy.step(plane, hand, kTick);
  put_at(plane, 0.004);
  return proxy.step(plane, hand, kTick);
}

TEST(Moving, SurfaceThatPassesAFreeProxyTakesItAlong) {
  EXPECT_NEAR(passed_by(PlaneField({.reanchor_reach = 0.01})).force.z(), 1.5, 1e-9);
}

TEST(Moving, SurfaceThatAppearsOverAFreeProxyDoesNotPushIt) {
  const Contact c = passed_by(PlaneField());
  EXPECT_NEAR(c.proxy.z(), 0.004, 1e-9);
  EXPECT_LE(c.force.norm(), 0.05);
}

TEST(Moving, SurfaceThatIsThereAtOnceWithoutAChangeDoesNotPushAFreeProxy) {
  const Vector3d hand(0, 0, 0.001);
  test::SheetField sheet;
  sheet.thickness = 0.02;
  sheet.height = -0.01;
  Proxy proxy;
  ASSERT_FALSE(proxy.step(sheet, hand, kTick).touching);
  sheet.height = 0.004;
  const Contact c = proxy.step(sheet, hand, kTick);
  ASSERT_TRUE(c.touching);
  EXPECT_NEAR(c.proxy.z(), 0.004, 1e-6);
  EXPECT_TRUE(has(c.notes, ContactNote::softer));
  EXPECT_LE(c.force.norm(), 0.051);
}

TEST(Moving, VanishedCloudLetsItsForceFade) {
  const PlaneField plane;
  PlaneField gone({.reanchor_reach = 0});
  Proxy proxy = pressed(plane);
  put_at(gone, -1);
  double before = 1.5;
  for (int i = 0; i < 200; ++i) {
    const Contact c = proxy.step(gone, kHip, kTick);
    EXPECT_FALSE(c.touching);
    EXPECT_EQ((c.proxy - kHip).norm(), 0);
    EXPECT_LE(before - c.force.z(), 0.05 * 1.5);
    before = c.force.z();
  }
  EXPECT_EQ(before, 0);
}

TEST(Moving, SpringThatTakesOverIsPaidForByTheOneThatEnded) {
  for (const double dz : {-0.002, 0.006}) {  // farther than 1 m/s in a millisecond
    PlaneField plane;
    Proxy proxy = pressed(plane);
    put_at(plane, dz);
    double before = 1.5;
    for (int i = 0; i < 200; ++i) {
      const Contact c = proxy.step(plane, kHip, kTick);
      EXPECT_LE(std::abs(before - c.force.z()), 0.05 * 1.5);
      EXPECT_LE(c.stiffness, 500);
      before = c.force.z();
    }
    const double stretch = dz - kHip.z();
    EXPECT_LE(0.5 * before * stretch, 0.5 * 500 * 0.003 * 0.003 * 1.02);
    EXPECT_NEAR(before, dz < 0 ? 500 * stretch : 0.5, 0.01);
  }
}

// It appears with a presence of 0, as what a camera begins to see.
TEST(Moving, WhatPopsUpUnderAHandGivesItNoEnergy) {
  for (const double dz : {0.002, 0.006, 0.015}) {
    PlaneField plane;
    Proxy proxy = pressed(plane);
    put_at(plane, dz);
    for (int i = 0; i < 600; ++i) {
      plane.set_surface({.presence = std::min(1.0, i / 500.0)});
      (void)proxy.step(plane, kHip, kTick);
    }
    double energy = 0;
    const double step = 2e-5;
    for (double z = kHip.z(); z < dz + 0.001; z += step) {
      energy += proxy.step(plane, {kHip.x(), kHip.y(), z}, kTick).force.z() * step;
    }
    EXPECT_LE(energy, 1.02 * 0.5 * 500 * 0.003 * 0.003) << dz;
  }
}

TEST(Moving, ResetForgetsASpringThatFades) {
  PlaneField plane;
  Proxy proxy = pressed(plane);
  put_at(plane, -1);
  EXPECT_GT(proxy.step(plane, kHip, kTick).force.z(), 1);
  proxy.reset(kHip);
  EXPECT_EQ(proxy.step(plane, kHip, kTick).force.norm(), 0);
}

TEST(Moving, AResetIntoASolidPushesAtOnce) {
  PlaneField plane;
  plane.set_pose(Eigen::Isometry3d::Identity());
  Proxy proxy;
  proxy.reset({0, 0, -0.002});
  EXPECT_NEAR(proxy.step(plane, {0, 0, -0.002}, kTick).force.z(), 1, 1e-6);
}

TEST(Moving, ASlowPlaneThatDoesNotTellItsVelocityCarriesTheHand) {
  PlaneField plane;
  Proxy proxy = pressed(plane);
  double force = 0;
  for (int i = 1; i <= 100; ++i) {
    put_at(plane, 1.5e-4 * i);
    force = proxy.step(plane, kHip, kTick).force.z();
  }
  EXPECT_NEAR(force, 500 * (0.015 + 0.003), 0.05);
}

TEST(Moving, LostContactKeepsItsSpringBrieflyThenFades) {
  const PlaneField plane;
  const FogField fog;
  Proxy proxy = pressed(plane);
  double last = 1.5;
  for (int i = 1; i < 20; ++i) {
    const Contact c = proxy.step(fog, kHip, kTick);
    EXPECT_TRUE(has(c.notes, ContactNote::lost));
    EXPECT_NEAR(c.force.z(), last, 1e-9);
  }
  for (int i = 0; i < 100; ++i) {
    const double force = proxy.step(fog, kHip, kTick).force.norm();
    EXPECT_LE(last - force, 0.05 * 1.5);
    last = force;
  }
  EXPECT_LE(last, 0.015);
}

TEST(Moving, LostSurfaceThatComesBackIsFoundAgain) {
  const PlaneField plane;
  Proxy proxy = pressed(plane);
  for (int i = 0; i < 5; ++i) (void)proxy.step(FogField{}, kHip, kTick);
  const Contact c = proxy.step(plane, kHip, kTick);
  EXPECT_TRUE(c.touching);
  EXPECT_NEAR(c.force.z(), 1.5, 1e-9);
}

TEST(Moving, LostContactNeverGoesThroughWhatItStoodOn) {
  DullPlateField plate;
  Proxy proxy;
  proxy.reset({0, 0, 0.03});
  const Vector3d beyond(0, 0, -0.08);
  drive(proxy, plate, {0, 0, 0.03}, beyond, 1);
  plate.dull = true;
  const Contact lost = rest(proxy, plate, beyond, 500);
  EXPECT_LE(lost.force.norm(), 1e-6);
  EXPECT_TRUE(has(lost.notes, ContactNote::lost));
  EXPECT_NEAR(lost.proxy.z(), 0, 1e-9);
  plate.dull = false;
  const Contact found = rest(proxy, plate, {0, 0, -0.001}, 100);
  EXPECT_NEAR(found.force.z(), 0.5, 1e-6);
}

TEST(Moving, LostContactEndsWhenTheHandComesOut) {
  DullPlateField plate;
  Proxy proxy;
  proxy.reset({0, 0, 0.03});
  drive(proxy, plate, {0, 0, 0.03}, {0, 0, -0.01}, 1);
  plate.dull = true;
  const Contact lost = rest(proxy, plate, {0, 0, 0.01}, 500);
  EXPECT_TRUE(lost.touching);
  const Contact out = rest(proxy, plate, {0, 0, 0.03}, 2);
  EXPECT_FALSE(out.touching);
  EXPECT_EQ(out.proxy.z(), 0.03);
}

TEST(Moving, SearchCutShortKeepsTheSpring) {
  const PlaneField plane;
  DoubtfulField field;
  field.floor = -0.0029;
  Proxy proxy = pressed(plane);
  Contact c = proxy.step(field, kHip, kTick);
  EXPECT_TRUE(has(c.notes, ContactNote::sweep_truncated));
  EXPECT_TRUE(c.touching);
  EXPECT_NEAR(c.force.z(), 500 * (c.proxy.z() - kHip.z()), 1e-12);
  double before = c.force.z();
  for (int i = 0; i < 4; ++i) {
    c = proxy.step(field, kHip, kTick);
    EXPECT_LE(c.force.z(), before + 1e-6);
    EXPECT_GT(c.force.z(), 0.05 - 1e-6);
    before = c.force.z();
  }
  EXPECT_EQ(c.notes, ContactNote::none);
  EXPECT_NEAR(c.force.z(), 0.05, 1e-6);
}

TEST(Moving, StartEmbeddedGoesToTheNearestFront) {
  const SphereField sphere(0.04);
  Proxy proxy;
  const Contact c = proxy.step(sphere, {0, 0.038, 0}, kTick);
  EXPECT_TRUE(c.touching);
  EXPECT_NEAR(c.force.y(), 1, 1e-6);
}

TEST(Moving, StiffnessFollowsTheMaterialWithoutGivingEnergy) {
  PlaneField plane;
  plane.set_surface({.stiffness_factor = 0.5, .source = 3});
  Proxy proxy = pressed(plane);
  EXPECT_EQ(proxy.step(plane, kHip, kTick).stiffness, 250);
  plane.set_surface({.stiffness_factor = 1});
  EXPECT_EQ(rest(proxy, plane, kHip).stiffness, 250);
  drive(proxy, plane, kHip, {0.004, 0, 0.001}, 0.1);
  EXPECT_EQ(drive(proxy, plane, {0.004, 0, 0.001}, kHip, 0.1).stiffness, 500);
}

TEST(Moving, SurfaceThatIsNoLongerPresentFadesUnderTheHand) {
  PlaneField plane;
  Proxy proxy = pressed(plane);
  plane.set_surface({.presence = 0});
  double last = 1.5;
  for (int i = 0; i < 200; ++i) {
    const double force = proxy.step(plane, kHip, kTick).force.norm();
    EXPECT_LE(force, last);
    EXPECT_GT(force, 0.95 * last - 1e-12);
    last = force;
  }
  EXPECT_LT(last, 1e-3);
}

}  // namespace
}  // namespace palpate::test
