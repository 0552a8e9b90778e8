// What a remote device tells of a hand that turns, and what it lets flow to its wrist and fingers.
#include <gtest/gtest.h>

#include "device/remote_protocol_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::RemoteProtocolTest;

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
  EXPECT_EQ(step().angular_velocity, Vector3d::Zero()) << "it is not turned";
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
