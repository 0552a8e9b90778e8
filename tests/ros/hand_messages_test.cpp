// What the bridge and recordings tell of a hand that holds a tool which turns.
#include "ros/hand_messages.hpp"

#include <gtest/gtest.h>

#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond turn_of(const message::PoseStamped& told) {
  const auto& q = told.pose.orientation;
  return {q.w, q.x, q.y, q.z};
}

// A box that the hand has turned into a sheet, which the sheet keeps flat.
class HandMessages : public testing::Test {
 protected:
  const ServoState& press(const ServoOptions& options) {
    test::add_sheet(scene_);
    device_.info().maximum_force = 10;
    device_.info().maximum_torque = 1;
    Servo servo(device_, scene_, options);
    for (int i = 0; i < 400; ++i) {
      const double share = std::min(1.0, i / 300.0);
      device_.state().position.z() = 0.03 - 0.028 * share;
      device_.state().orientation = Eigen::AngleAxisd(0.1 * share, Vector3d::UnitY());
      servo.tick(1e-3 * i);
    }
    return state_ = servo.state();
  }

  Scene scene_;
  test::FreeDevice device_{Vector3d(0, 0, 0.03)};
  ServoState state_;
};

TEST_F(HandMessages, TellTheTorqueAndWhereTheToolIs) {
  ServoOptions options = test::first_links();
  options.tool = std::make_shared<const Tool>(Tool::from_text("box:20x30x10", 4e-3));
  const ServoState& state = press(options);
  const message::WrenchStamped wrench = ros::hand_wrench({}, state);
  EXPECT_EQ(wrench.wrench.force.z, state.force.z());
  EXPECT_EQ(wrench.wrench.torque.y, state.torque.y());
  EXPECT_LT(wrench.wrench.torque.y, -1e-3);
  const message::PoseStamped proxy = ros::proxy_pose({}, state);
  EXPECT_NEAR(proxy.pose.position.z, 5e-3, 1e-4);
  EXPECT_LT(turn_of(proxy).angularDistance(Quaterniond::Identity()), 1e-2) << "flat";
  EXPECT_NEAR(turn_of(ros::hand_pose({}, state)).angularDistance(Quaterniond::Identity()), 0.1,
              1e-9);
  const auto& frame = ros::proxy_frame({}, "hand", state).transform.rotation;
  EXPECT_EQ(frame.y, proxy.pose.orientation.y);
}

TEST_F(HandMessages, TellThatAPointIsHeldAsTheHandIs) {
  const ServoState& state = press({});
  EXPECT_EQ(ros::hand_wrench({}, state).wrench.torque.y, 0);
  EXPECT_EQ(turn_of(ros::proxy_pose({}, state)).coeffs(), state.orientation.coeffs());
}

}  // namespace
}  // namespace palpate
