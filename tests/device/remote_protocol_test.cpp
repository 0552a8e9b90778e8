// Whom a remote device believes and how much force it lets flow: no socket, no clock.
#include <gtest/gtest.h>

#include <algorithm>

#include "device/remote_protocol_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::kClient;
using test::kOther;
using test::RemoteProtocolTest;

TEST_F(RemoteProtocolTest, IsSilentUntilSomebodySpeaks) {
  EXPECT_EQ(step().status, DeviceState::Status::silent);
  EXPECT_FALSE(link_.answer({.force = {0, 0, 1}})) << "nobody to answer to";
  EXPECT_FALSE(link_.farewell());
}

TEST_F(RemoteProtocolTest, FirstPlaceIsToldAsSilentSoThatForcesBeginWhereTheHandIs) {
  say(0.03);
  say(0.03);
  const DeviceState first = step();
  EXPECT_EQ(first.status, DeviceState::Status::silent);
  EXPECT_EQ(first.position.x(), 0.03);
  EXPECT_LE(felt(), 0);
  say(0.031);
  EXPECT_EQ(step().status, DeviceState::Status::ok);
}

TEST_F(RemoteProtocolTest, ForceComesUpFromZeroAndIsNeverMoreThanTheMaximum) {
  talk(0.002);
  double last = felt();
  EXPECT_LT(last, 5 * 0.004 / 0.5);
  for (int i = 0; i < 600; ++i) {
    talk(1e-3);
    const double now = felt();
    ASSERT_LE(now, std::min(5.0, last + 5 * 1.001e-3 / 0.5));
    ASSERT_GE(now, last);
    last = now;
  }
  EXPECT_EQ(last, 5);
  EXPECT_EQ(felt(-3), -3) << "a force that may flow is not changed";
}

TEST_F(RemoteProtocolTest, SilenceFadesTheForceAndTellsItsEndOnce) {
  talk(1);
  EXPECT_EQ(step(0.098).status, DeviceState::Status::ok) << "short of the silence";
  EXPECT_EQ(felt(), 5);
  EXPECT_EQ(step(2e-3).status, DeviceState::Status::silent);
  double last = 5;
  bool fading = false;
  for (int i = 0; i < 60; ++i) {
    step();
    const auto packet = link_.answer({.force = {0, 0, 100}});
    if (!packet) break;
    EXPECT_FALSE(packet->live);
    ASSERT_LE(packet->force.z(), last);
    fading = fading || (packet->force.z() > 1 && packet->force.z() < 4);
    last = packet->force.z();
  }
  EXPECT_TRUE(fading);
  EXPECT_EQ(last, 0);
  step();
  EXPECT_FALSE(link_.answer({.force = {0, 0, 100}})) << "the last packet said zero";
}

TEST_F(RemoteProtocolTest, ComesBackSoftly) {
  talk(1);
  step(0.5);
  static_cast<void>(felt());
  EXPECT_EQ(say(-0.05), PacketFlaw::none);
  const DeviceState back = step();
  EXPECT_EQ(back.status, DeviceState::Status::silent);
  EXPECT_EQ(back.position.x(), -0.05);
  EXPECT_LE(felt(), 0);
  say(-0.05);
  EXPECT_EQ(step().status, DeviceState::Status::ok);
  EXPECT_LT(felt(), 0.05);
}

TEST_F(RemoteProtocolTest, WhoTakesAnothersPlaceInTheSameStepStartsSoftlyToo) {
  talk(1);
  ASSERT_EQ(felt(), 5);
  packet_.leaving = true;
  EXPECT_EQ(say(0.01), PacketFlaw::none);
  packet_ = {};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(say(0.2, kOther), PacketFlaw::none);
    step();
    ASSERT_LT(felt(), 0.05) << i;
  }
  EXPECT_EQ(link_.client(), kOther);
}

TEST_F(RemoteProtocolTest, AClientThatStartsAnewAtOnceStartsSoftlyToo) {
  talk(1);
  packet_.leaving = true;
  EXPECT_EQ(say(0.01), PacketFlaw::none);
  step();
  packet_ = {};
  EXPECT_EQ(talk(0.003).status, DeviceState::Status::ok);
  EXPECT_LT(felt(), 0.05);
}

TEST_F(RemoteProtocolTest, BelievesNeitherRepeatedNorOvertakenPackets) {
  talk(0.01);
  EXPECT_EQ(repeat(), PacketFlaw::order);
  packet_.sequence -= 3;
  packet_.position.x() = 9;
  EXPECT_EQ(repeat(), PacketFlaw::order);
  packet_.sequence += 10;
  packet_.stamp -= 1;
  EXPECT_EQ(repeat(), PacketFlaw::order) << "its stamp went back";
  EXPECT_EQ(step().position.x(), 0.01);
}

TEST_F(RemoteProtocolTest, RepeatedPacketsDoNotKeepItAlive) {
  talk(0.01);
  for (int i = 0; i < 500; ++i) {
    static_cast<void>(repeat());
    const DeviceState state = step();
    if (i > 100) {
      ASSERT_EQ(state.status, DeviceState::Status::silent) << i;
    }
  }
}

TEST_F(RemoteProtocolTest, ListensToOneClientUntilItIsSilentOrLeaves) {
  talk(0.01);
  EXPECT_EQ(say(0.5, kOther), PacketFlaw::other_client);
  EXPECT_EQ(step().position.x(), 0.01);
  step(0.2);
  packet_ = {};
  EXPECT_EQ(say(0.5, kOther), PacketFlaw::none) << "numbers may begin anew";
  EXPECT_EQ(step().position.x(), 0.5);
  EXPECT_EQ(link_.client(), kOther);
  packet_.leaving = true;
  EXPECT_EQ(say(0.5, kOther), PacketFlaw::none);
  EXPECT_EQ(step().status, DeviceState::Status::silent) << "at once";
  packet_ = {};
  EXPECT_EQ(say(0.1, kClient), PacketFlaw::none);
}

TEST_F(RemoteProtocolTest, RefusesClientsThatCannotBeAnswered) {
  EXPECT_EQ(say(0.1, SocketAddress{}), PacketFlaw::no_address);
  EXPECT_EQ(step().status, DeviceState::Status::silent);
}

TEST_F(RemoteProtocolTest, VelocityIsThatOfTheLastTwoPlaces) {
  talk(0.01);
  say(0.0102);
  EXPECT_NEAR(step().velocity.x(), 0.2, 1e-9);
  EXPECT_NEAR(step().velocity.x(), 0.2, 1e-9) << "nothing new";
  packet_.stamp += 4e-3;  // it came early
  say(0.0112);
  EXPECT_NEAR(step().velocity.x(), 0.2, 1e-9) << "by the client's clock";
  step(3e-3);
  say(0.0122);  // it came late, or its stamp is wrong
  EXPECT_NEAR(step().velocity.x(), 0.25, 1e-9) << "by the time of its arrival";
  EXPECT_EQ(step(0.2).velocity, Vector3d::Zero()) << "silent";
}

TEST_F(RemoteProtocolTest, BelievesNoVelocityThatPositionsDoNotShow) {
  talk(0.01);
  packet_.has_velocity = true;
  for (int i = 0; i < 10; ++i) {
    packet_.velocity = {i % 2 == 0 ? 1000.0 : -1000.0, 0, 0};
    EXPECT_EQ(say(0.01), PacketFlaw::none);
    EXPECT_EQ(step().velocity, Vector3d::Zero());
  }
}

TEST_F(RemoteProtocolTest, TellsWhenTheHandWasReadLast) {
  talk(0.01);
  say(0.01);
  const double read = now_;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(step().time, read);
  say(0.01);
  EXPECT_GT(step().time, read) << "it rests";
}

TEST_F(RemoteProtocolTest, KeepsTheVersionThatAClientBeganWith) {
  packet_.version = RemoteVersion::kTurns;
  packet_.turns.orientation = Eigen::AngleAxisd(0.3, Vector3d::UnitY());
  talk(0.01);
  packet_.version = RemoteVersion::kForces;
  EXPECT_EQ(say(0.02), PacketFlaw::mixed);
  const DeviceState state = step();
  EXPECT_EQ(state.position.x(), 0.01);
  EXPECT_NEAR(state.orientation.angularDistance(packet_.turns.orientation), 0, 1e-12);
  EXPECT_EQ(link_.answer({})->version, RemoteVersion::kTurns);
  EXPECT_EQ(link_.farewell()->version, RemoteVersion::kTurns);
  step(0.2);
  EXPECT_EQ(say(0.02), PacketFlaw::none) << "a new beginning";
}

TEST_F(RemoteProtocolTest, AnswersWithWhatItAnswers) {
  talk(0.01);
  const auto packet = link_.answer({.force = {0, 0, 0.001}});
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->answered, packet_.sequence);
  EXPECT_EQ(packet->stamp, packet_.stamp);
  EXPECT_TRUE(packet->live);
  EXPECT_FALSE(packet->closing);
  const auto last = link_.farewell();
  ASSERT_TRUE(last);
  EXPECT_GT(last->sequence, packet->sequence);
  EXPECT_TRUE(last->closing);
  EXPECT_EQ(last->force, Vector3d::Zero());
}

}  // namespace
}  // namespace palpate
