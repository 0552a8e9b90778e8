// A guided hand on its way from touch to touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "device/asker.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::Asker;
using test::kAskedEvery;

// Down at 0.1 s, a press from there to 1 s, and off again at 1.2 s.
Trajectory one_press() {
  return {{0, {0, 0, 0.05}},
          {0.1, {0, 0, -0.01}},
          {1, {0.1, 0, -0.01}},
          {1.2, {0.1, 0, 0.05}},
          {3, {0.1, 0, 0.05}}};
}

TEST(HandOnItsWay, LiftsWhereNothingHoldsItsPress) {
  RemoteTarget remote;
  const Press press{0.1, 1, 1.2, 0.008, {{0, 0, 0.05}, {0.05, 0, 0.05}, {0.1, 0, 0.05}}};
  TeleoperatedHand hand(remote, one_press(), {.travel_speed = 0.2, .presses = {press}});
  Asker held(hand, {0, 0, 0});
  EXPECT_NEAR(held.ask_until(0.501).position.z(), -0.01, 1e-12);
  held.device_at({0.0475, 0, -0.009});  // nearer to the target than one that is held
  EXPECT_GT(held.ask().position.x(), 0.04);
  TargetSource::Target last = held.ask_until(0.54);
  EXPECT_EQ(last.position.z(), -0.01) << "not yet lost: the pull is less for 40 ms";
  last = held.ask_until(0.56);
  EXPECT_NEAR((last.position - Vector3d(0.0475, 0, -0.009)).norm(), 0, 1e-3) << "where it is";
  // It follows: up to the nearest place over the press, and along that, with 1 N at most.
  double lowest = 1;
  for (Vector3d at = last.position; at.x() < 0.1; at = last.position) {
    ASSERT_LT(held.now(), 2);
    held.device_at(at);
    last = held.ask();
    EXPECT_LE((last.position - at).norm(), 0.2 * kAskedEvery + 1e-12);
    EXPECT_EQ(last.maximum_force, 1);
    if (last.position.x() > 0.06) lowest = std::min(lowest, last.position.z());
  }
  EXPECT_NEAR(lowest, 0.05, 1e-12);
  last = held.follow_until(held.now() + 0.1);
  EXPECT_EQ(last.position, Vector3d(0.1, 0, 0.05));
  EXPECT_TRUE(std::isinf(last.maximum_force)) << "it has caught up";
}

// An edge that holds a hand back lets go of it some time: with all of its pull it would be thrown.
TEST(HandOnItsWay, LiftsWhereAnEdgeCaughtIt) {
  RemoteTarget remote;
  const Press press{0.1, 1, 1.2, 0.004, {{0, 0, 0.05}, {0.1, 0, 0.05}}};
  TeleoperatedHand hand(remote, one_press(), {.presses = {press}});
  Asker caught(hand, {0, 0, -0.006});
  EXPECT_NEAR(caught.ask_until(0.35).position.x(), 0.25 / 0.9 * 0.1, 1e-3);
  const TargetSource::Target last = caught.ask_until(0.42);
  EXPECT_LT(last.position.x(), 1e-3) << "32 mm away it is no press any more";
  EXPECT_GT(last.position.z(), -0.006);
  EXPECT_EQ(last.maximum_force, 1);
}

TEST(HandOnItsWay, GoesTheWayThatACommandNamesFromWhereItIs) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, {}, {.speed = 2});
  Asker asker(hand, {0, 0, 0});
  asker.ask();
  static_cast<void>(remote.move({.position = {0, 0, -0.05}, .maximum_force = 1}, 0));
  EXPECT_LT(asker.ask_until(0.09).position.z(), -0.04);
  Way way;
  way.corners = {{Vector3d(0, 0, 0.02), Vector3d(0.1, 0, 0.02), Vector3d(0.1, 0, 0.01)}};
  way.size = 3;
  way.speed = 0.25;
  ASSERT_TRUE(remote.fly({.maximum_force = 2}, way, true, 0.09));
  TargetSource::Target last = asker.ask();
  EXPECT_LT(last.position.norm(), 0.25 * kAskedEvery) << "from where it is";
  bool over_the_corner = false;
  for (Vector3d at(0, 0, 0); asker.now() < 2; at = last.position) {
    asker.device_at(at);
    remote.keep_alive();
    last = asker.ask();
    EXPECT_LE((last.position - at).norm(), 0.25 * kAskedEvery + 1e-12);
    over_the_corner = over_the_corner || last.position == way.corners[1];
  }
  EXPECT_EQ(last.position, way.corners[2]);
  way.corners[2].z() = 0;
  ASSERT_TRUE(remote.fly({.maximum_force = 2}, way, false, 2));
  EXPECT_NEAR(asker.ask().position.z(), 0.01, 0.25 * kAskedEvery)
      << "goes on to the end, which moved";
  static_cast<void>(remote.move({.position = {0.1, 0, -0.05}, .maximum_force = 1}, 2.016));
  EXPECT_LT(asker.ask().maximum_force, 0.2) << "presses softly first";
  remote.keep_alive();
  EXPECT_LT(asker.ask_until(2.05).maximum_force, 0.7);
}

// A page that hovers says a new end again and again, also after the hand has arrived.
TEST(HandOnItsWay, FollowsTheEndOfItsWayAfterItHasArrived) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, {}, {.speed = 2});
  Asker asker(hand, {0, 0, 0});
  asker.ask();
  Way way;
  way.corners = {{Vector3d(0, 0, 0.005), Vector3d(0.005, 0, 0.005)}};
  way.size = 2;
  way.speed = 0.25;
  ASSERT_TRUE(remote.fly({}, way, true, 0));
  for (int i = 0; i < 500; ++i) {
    remote.keep_alive();
    asker.ask();
  }
  EXPECT_EQ(asker.ask().position, way.corners[1]);
  way.corners[1].y() = 1e-3;
  ASSERT_TRUE(remote.fly({}, way, false, 0.6));
  EXPECT_NEAR(asker.follow_until(asker.now() + 0.08).position.y(), 1e-3, 1e-12);
}

TEST(HandOnItsWay, BeginsAWayThatHasAnotherNumberOfCorners) {
  RemoteTarget remote;
  Way way;
  way.corners.fill(Vector3d::Zero());
  way.size = 3;
  way.speed = 1;
  ASSERT_TRUE(remote.fly({}, way, true, 0));
  ASSERT_TRUE(remote.fly({}, way, false, 0.1));
  EXPECT_EQ(remote.command()->ways, 1u);
  way.size = 2;
  ASSERT_TRUE(remote.fly({}, way, false, 0.2));
  EXPECT_EQ(remote.command()->ways, 2u);
}

TEST(HandOnItsWay, RefusesWaysThatLeadNowhere) {
  RemoteTarget remote;
  Way way;
  EXPECT_FALSE(remote.fly({}, way, true, 0));
  way.corners.fill(Vector3d::Zero());
  way.size = Way::kMost;
  EXPECT_FALSE(remote.fly({}, way, true, 0)) << "no speed";
  way.speed = 1;
  way.corners[3].x() = std::nan("");
  EXPECT_FALSE(remote.fly({}, way, true, 0));
  way.corners[3].x() = 0;
  EXPECT_TRUE(remote.fly({}, way, true, 0));
}

TEST(HandOnItsWay, RefusesPressesOutOfOrder) {
  RemoteTarget remote;
  const auto make = [&](std::vector<Press> presses) {
    TeleoperatedHand(remote, one_press(), {.presses = std::move(presses)});
  };
  EXPECT_THROW(make({{0.5, 0.4, 1, 0}}), Error);
  EXPECT_THROW(make({{0.1, 0.4, 0.3, 0}}), Error);
  EXPECT_THROW(make({{0.5, 0.6, 0.7, 0}, {0.1, 0.2, 0.3, 0}}), Error);
  EXPECT_THROW(make({{0.1, 0.4, 0.5, -1}}), Error);
}

}  // namespace
}  // namespace palpate
