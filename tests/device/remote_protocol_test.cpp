// Whom a remote device believes and how much force it lets flow: no socket, no clock.
#include "device/remote_protocol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace palpate {
namespace {

using Eigen::Vector3d;

SocketAddress address(const char* name) {
  SocketAddress result;
  result.size = std::strlen(name) + 1;
  std::memcpy(result.path.data(), name, result.size);
  return result;
}

const SocketAddress kClient = address("/run/one");
const SocketAddress kOther = address("/run/other");

class RemoteProtocolTest : public testing::Test {
 protected:
  // The client's next good packet, with the hand at x.
  PacketFlaw say(double x, const SocketAddress& from = kClient) {
    packet_.sequence += 1;
    packet_.stamp += 1e-3;
    packet_.position.x() = x;
    return repeat(from);
  }
  PacketFlaw repeat(const SocketAddress& from = kClient) {
    return link_.receive(encode(packet_), from, now_);
  }
  // A step without anything to hear.
  DeviceState step(double dt = 1e-3) {
    now_ += dt;
    return link_.state(now_);
  }
  // Good packets for a time; the last state.
  DeviceState talk(double duration) {
    DeviceState state;
    for (const double end = now_ + duration; now_ < end;) {
      EXPECT_EQ(say(0.01), PacketFlaw::none);
      state = step();
    }
    return state;
  }
  double felt(double force = 100) {
    const auto packet = link_.answer({.force = {0, 0, force}});
    return packet ? packet->force.z() : -1;
  }

  RemoteDeviceOptions options_{.path = "none", .maximum_force = 5};
  RemoteProtocol link_{options_};
  StatePacket packet_;
  double now_ = 1000;
};

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

TEST_F(RemoteProtocolTest, VelocityIsToldOrThatOfTheLastTwoPlaces) {
  talk(0.01);
  say(0.0102);
  EXPECT_NEAR(step().velocity.x(), 0.2, 1e-9);
  packet_.has_velocity = true;
  packet_.velocity = {0, 3, 0};
  say(0.02);
  EXPECT_EQ(step().velocity, Vector3d(0, 3, 0));
  EXPECT_EQ(step(0.2).velocity, Vector3d::Zero()) << "silent";
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

class RemoteTurnsTest : public RemoteProtocolTest {
 protected:
  RemoteTurnsTest() {
    options_.maximum_torque = 0.2;
    options_.maximum_grip = 4;
    link_ = RemoteProtocol(options_);
    packet_.version = RemoteVersion::kTurns;
    packet_.turns.renders_torque = packet_.turns.renders_grip = true;
  }
  [[nodiscard]] std::optional<ForcePacket> answer() {
    return link_.answer({{0, 0, 100}, {0, 100, 0}, -100});
  }
};

TEST_F(RemoteTurnsTest, TellsTurnsAndOpening) {
  talk(0.002);
  packet_.turns.orientation = Eigen::AngleAxisd(0.01, Vector3d::UnitY());
  packet_.turns.opening = 0.03;
  say(0.01);
  const DeviceState guessed = step();
  EXPECT_NEAR(guessed.orientation.angularDistance(packet_.turns.orientation), 0, 1e-12);
  EXPECT_EQ(guessed.gripper, 0.03);
  EXPECT_NEAR(guessed.angular_velocity.y(), 10, 1e-6) << "from the last two packets";
  packet_.turns.has_velocity = true;
  packet_.turns.velocity = {1, 2, 3};
  say(0.01);
  EXPECT_EQ(step().angular_velocity, Vector3d(1, 2, 3));
  EXPECT_EQ(step(0.2).angular_velocity, Vector3d::Zero()) << "silent";
}

TEST_F(RemoteTurnsTest, LimitsTorqueAndGripToTheShareOfTheForce) {
  EXPECT_EQ(talk(0.25).status, DeviceState::Status::ok);
  const ForcePacket half = *answer();
  EXPECT_NEAR(half.torque.y() / 0.2, half.force.z() / 5, 1e-12);
  EXPECT_NEAR(half.grip / -4, half.force.z() / 5, 1e-12);
  EXPECT_GT(half.force.z(), 1);
  EXPECT_LT(half.force.z(), 4);
  talk(1);
  EXPECT_NEAR(answer()->torque.y(), 0.2, 1e-12);
  EXPECT_NEAR(answer()->grip, -4, 1e-12);
  step(0.2);  // silent, and faded
  EXPECT_EQ(answer()->torque, Vector3d::Zero());
  EXPECT_FALSE(answer()) << "all is zero, and was said";
}

TEST_F(RemoteTurnsTest, SendsNoTorqueToAClientThatHasNoMotorsForIt) {
  packet_.turns.renders_torque = packet_.turns.renders_grip = false;
  talk(1);
  const ForcePacket sent = *answer();
  EXPECT_EQ(sent.version, RemoteVersion::kTurns);
  EXPECT_EQ(sent.torque, Vector3d::Zero());
  EXPECT_EQ(sent.grip, 0);
  EXPECT_NEAR(sent.force.z(), 5, 1e-12);
}

TEST_F(RemoteTurnsTest, AnswersAClientOfThreeAxesInItsVersion) {
  packet_ = {};
  talk(1);
  const ForcePacket sent = *answer();
  EXPECT_EQ(sent.version, RemoteVersion::kForces);
  EXPECT_EQ(sent.torque, Vector3d::Zero());
  EXPECT_EQ(encode(sent).size, 56u);
}

}  // namespace
}  // namespace palpate
