// Nodes that own a hand with a wrist get torques where their preset has a place for them and a
// profile says that there are motors.
#include <gtest/gtest.h>

#include <mutex>
#include <optional>

#include "dds/hostile.hpp"
#include "message/sensor_types.hpp"
#include "message/transforms.hpp"
#include "palpate/device/hardware.hpp"
#include "support/folder.hpp"

namespace palpate::hostile {
namespace {

using Eigen::Vector3d;
using message::Float64MultiArray;
using message::PoseStamped;
using message::WrenchStamped;

constexpr double kTurning = 0.5;  // rad/s, of the hand about the node's z
const Vector3d kForce(0.1, 0.2, 0.3);
const Vector3d kTorque(0.01, 0.02, 0.03);

// Tells poses that turn and keeps what it was told last.
template <class T>
class TurningNode {
 public:
  TurningNode(const std::string& poses, const std::string& forces)
      : poses_(participant_, poses, {}),
        forces_(participant_, forces, {.reliable = true}),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  [[nodiscard]] std::optional<T> told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const double now = message::system_now();
      const double half = 0.5 * kTurning * std::fmod(now, 1000);
      poses_.write({{message::to_time(now), "hand"},
                    {{0.01, 0.02, 0.03}, {0, 0, std::sin(half), std::cos(half)}}});
      {
        const std::lock_guard lock(mutex_);
        for (T told; forces_.take(told);) told_ = told;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  dds::Participant participant_{own_domain()};
  dds::Writer<PoseStamped> poses_;
  dds::Reader<T> forces_;
  std::mutex mutex_;
  std::optional<T> told_;
  std::jthread thread_;  // last: it uses all of the above
};

class HandWrench : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("wrist.toml", "[wrist]\nmaximum_force = 4\nmaximum_torque = 0.1\n");
  }
  std::unique_ptr<Device> open(const std::string& preset) {
    return open_device("ros:" + preset + ",profile=" + (folder_ / "wrist.toml"), clock_);
  }
  // Asks for force and torque, as a servo does, until `done`.
  bool pushes_until(Device& device, const std::function<bool()>& done) {
    return before_long([&] {
      state_ = device.read();
      const bool ok = state_.status == DeviceState::Status::ok;
      device.write_wrench(ok ? Wrench{kForce, kTorque, 1} : Wrench{});
      return done();
    });
  }

  test::Folder folder_;
  SteadyClock clock_;
  DeviceState state_;
};

TEST_F(HandWrench, OfAnyNodeIsToldAsItIs) {
  TurningNode<WrenchStamped> node("/hand/pose", "/hand/wrench");
  const auto device = open("generic,pose=/hand/pose,wrench=/hand/wrench");
  EXPECT_EQ(device->info().maximum_torque, 0.1);
  EXPECT_EQ(device->info().maximum_grip, 0);
  ASSERT_TRUE(pushes_until(*device, [&] {
    const auto told = node.told();
    return told && message::eigen(told->wrench.torque) == kTorque;
  })) << device->reason();
  EXPECT_EQ(message::eigen(node.told()->wrench.force), kForce);
  EXPECT_TRUE(pushes_until(
      *device,
      [&] { return (state_.angular_velocity - Vector3d(0, 0, kTurning)).norm() < 0.1 * kTurning; }))
      << "found from orientations: " << state_.angular_velocity.transpose();
}

// Its axes: x to the operator, y to the right; forces, torques, and a gripper that gets nothing.
TEST_F(HandWrench, OfForceDimensionsControllerStandsBehindTheForces) {
  TurningNode<Float64MultiArray> node("/fd/ee_pose", "/fd/fd_controller/commands");
  const auto device = open("fd,joints=7");
  EXPECT_EQ(device->info().maximum_torque, 0.1);
  const std::vector<double> wanted = {-0.2, 0.1, 0.3, -0.02, 0.01, 0.03, 0};
  EXPECT_TRUE(pushes_until(*device, [&] {
    const auto told = node.told();
    return told && told->data == wanted;
  })) << device->reason();
}

TEST_F(HandWrench, HasNoTorqueWhereNoMotorIsKnown) {
  TurningNode<Float64MultiArray> node("/fd/ee_pose", "/fd/fd_controller/commands");
  EXPECT_EQ(open("fd")->info().maximum_torque, 0) << "three joints";
  EXPECT_EQ(open_device("ros:fd,joints=6", clock_)->info().maximum_torque, 0) << "no profile";
  EXPECT_EQ(open_device("ros:fd,joints=6,profile=omega", clock_)->info().maximum_torque, 0);
}

}  // namespace
}  // namespace palpate::hostile
