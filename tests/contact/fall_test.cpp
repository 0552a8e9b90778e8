// What a step notes of geometry that gives way (ContactNote::fell).
#include <gtest/gtest.h>

#include <vector>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// Steps that were noted while the hand went along `way`.
int falls(Proxy& proxy, const Field& field, const std::vector<Vector3d>& way, double speed) {
  int count = 0;
  const auto look = [&count](const Vector3d&, const Contact& contact) {
    count += has(contact.notes, ContactNote::fell) ? 1 : 0;
  };
  for (std::size_t i = 1; i < way.size(); ++i) {
    drive(proxy, field, way[i - 1], way[i], speed, look);
  }
  return count;
}

TEST(Fall, OffTheEdgeOfABoxIsNotedOnce) {
  const BoxField box({0.1, 0.1, 0.04});
  const std::vector<Vector3d> way = {
      {0.03, 0, 0.03}, {0.03, 0, 0.016}, {0.06, 0, 0.016}, {0.06, 0, 0.03}};
  for (const double speed : {0.01, 0.1, 0.5}) {
    Proxy proxy;
    proxy.reset(way.front());
    EXPECT_EQ(falls(proxy, box, way, speed), 1) << speed;
  }
}

TEST(Fall, FromAHighFaceToALowOneIsNotedInContactToo) {
  const BoxField high({0.04, 0.04, 0.008});
  const PlaneField low;
  const UnionField both({&high, &low});
  const std::vector<Vector3d> way = {{0.01, 0, 0.02}, {0.01, 0, -1e-3}, {0.03, 0, -1e-3}};
  Proxy proxy;
  proxy.reset(way.front());
  EXPECT_EQ(falls(proxy, both, way, 0.1), 1);
  EXPECT_TRUE(proxy.step(both, way.back(), kTick).touching);
}

TEST(Fall, PressingStrokingAndWithdrawingIsNone) {
  const PlaneField plane;
  const SphereField sphere(0.04);
  const BowlField bowl(0.04);
  const std::vector<Vector3d> over = {{0, 0, 0.05},  {0, 0, -0.004}, {0.02, 0, -0.001},
                                      {0, 0, 0.001}, {0, 0, -1e-4},  {0, 0, 0.02}};
  const std::vector<Vector3d> around = {{0, 0, 0.05}, {0, 0, 0.03}, {0.03, 0, 0}, {0.05, 0.01, 0}};
  const std::vector<Vector3d> within = {{0, 0, 0}, {0, 0, 0.045}, {0.043, 0, 0}, {0, 0.01, 0}};
  for (const double speed : {1e-4, 1e-3, 0.1, 2., 20.}) {
    for (const double mu : {0., 0.4, 0.8}) {
      Proxy proxy({.friction = {.static_coefficient = mu, .dynamic_coefficient = mu / 2}});
      proxy.reset(over.front());
      EXPECT_EQ(falls(proxy, plane, over, speed), 0) << mu << " " << speed;
    }
    Proxy proxy;
    proxy.reset(around.front());
    EXPECT_EQ(falls(proxy, sphere, around, speed), 0) << speed;
    proxy.reset(within.front());
    EXPECT_EQ(falls(proxy, bowl, within, speed), 0) << speed;
  }
}

TEST(Fall, WhatVanishesUnderTheHandIsNotedOnce) {
  const std::vector<Vector3d> way = {{0, 0, 0.02}, {0, 0, -0.003}};
  Proxy proxy;
  proxy.reset(way.front());
  EXPECT_EQ(falls(proxy, PlaneField(), way, 0.1), 0);
  EXPECT_TRUE(has(proxy.step(EmptyField{}, way.back(), kTick).notes, ContactNote::fell));
  EXPECT_FALSE(has(proxy.step(EmptyField{}, way.back(), kTick).notes, ContactNote::fell));
}

TEST(Fall, ASurfaceThatSaysHowFastItLeavesIsNone) {
  PlaneField plane;
  plane.set_surface({.velocity = {0, 0, -0.5}});
  Proxy proxy;
  const Vector3d hip(0, 0, -2e-4);
  proxy.reset({0, 0, 0.01});
  EXPECT_EQ(falls(proxy, plane, {{0, 0, 0.01}, hip}, 0.1), 0);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Vector3d(0, 0, -5e-4));
  plane.set_pose(pose);
  const Contact contact = proxy.step(plane, hip, kTick);
  EXPECT_FALSE(contact.touching);
  EXPECT_FALSE(has(contact.notes, ContactNote::fell));
}

}  // namespace
}  // namespace palpate::test
