// Where a device stands in the scene, as the options behind its name say.
#include "apps/palpate/options/device_options.hpp"

#include <gtest/gtest.h>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/run/run.hpp"
#include "support/contains.hpp"

namespace palpate::app {
namespace {

using Eigen::Vector3d;
using test::contains;

std::string refusal(const std::string& device) {
  try {
    (void)parse_device(device);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

SourcePlan source(const std::string& name, SourceKind kind) {
  SourcePlan plan;
  plan.argument.name = name;
  plan.kind = kind;
  return plan;
}

TEST(DevicePlacement, IsTakenOffTheDevicesName) {
  const DevicePlan haply =
      parse_device("haply:04EA,scale=2.5,url=ws://desk:1,offset=0.1/-0.2/3e-2,clutch=1,frame=left");
  EXPECT_EQ(haply.path, "haply:04EA,url=ws://desk:1") << "the driver's own options stay";
  EXPECT_EQ(haply.placement.scale, 2.5);
  EXPECT_EQ(haply.placement.offset, Vector3d(0.1, -0.2, 0.03));
  EXPECT_EQ(haply.placement.clutch, 1);
  EXPECT_EQ(haply.placement.frame, "left");
  const DevicePlan remote = parse_device("remote:/tmp/hand,scale=0.5");
  EXPECT_EQ(remote.kind, DeviceKind::remote);
  EXPECT_EQ(remote.path, "/tmp/hand");
  EXPECT_EQ(remote.placement.scale, 0.5);
  EXPECT_EQ(parse_device("remote,clutch=0").path, "");
  const DevicePlan wrist = parse_device("remote:/tmp/hand,profile=wrist.toml,scale=0.5");
  EXPECT_EQ(wrist.path, "/tmp/hand");
  EXPECT_EQ(wrist.profile, "wrist.toml");
  EXPECT_EQ(parse_device("simulated,scale=2").placement.scale, 2);
  EXPECT_FALSE(parse_device("haply").placement.scale);
  EXPECT_FALSE(parse_device("haply").placement.clutch);
}

TEST(DevicePlacement, RefusesWhatIsNoValueOrNotForThatDevice) {
  EXPECT_TRUE(contains(refusal("remote,scale=0"), "above 0"));
  EXPECT_TRUE(contains(refusal("remote,scale=nan"), "finite"));
  EXPECT_TRUE(contains(refusal("remote,scale"), "scale"));
  EXPECT_TRUE(contains(refusal("remote,offset=1/2"), "X/Y/Z"));
  EXPECT_TRUE(contains(refusal("remote,clutch=32"), "0 to 31"));
  EXPECT_TRUE(contains(refusal("remote,clutch=0.5"), "not a button number"));
  EXPECT_TRUE(contains(refusal("remote,frame=a b"), "not a valid source name"));
  EXPECT_TRUE(contains(refusal("remote,scale=1,scale=1"), "twice"));
  EXPECT_TRUE(contains(refusal("remote:/tmp/hand,scal=1"), "scale=S"));
  EXPECT_TRUE(contains(refusal("simulated,profile=omega"), "scale=S"));
  EXPECT_TRUE(contains(refusal("scripted,scale=2"), "simulated"));
  EXPECT_TRUE(contains(refusal("simulated,clutch=1"), "only with remote and hardware"));
  EXPECT_TRUE(contains(refusal("simulated,frame=left"), "only with remote and hardware"));
  EXPECT_TRUE(contains(refusal("remote,clutch=a"), "'a' is not a finite number; write"));
  EXPECT_TRUE(contains(refusal("hapyl:04EA"), "did you mean haply?"));
  EXPECT_TRUE(contains(refusal("omega"), "omega is a device of forcedimension"));
  EXPECT_TRUE(contains(refusal("inverse3,scale=2"), "inverse3 is a device of haply"));
}

TEST(DevicePlacement, FrameNamesASourceThatHasACamera) {
  const SourcePlan left = source("left", SourceKind::stream);
  const SourcePlan right = source("right", SourceKind::depth_image);
  const SourcePlan ball = source("ball", SourceKind::cloud);
  EXPECT_EQ(camera_named("left", {left, right}), "left");
  EXPECT_EQ(camera_named("camera", {ball, right}), "right");
  const auto refused = [](const std::string& frame, const std::vector<SourcePlan>& sources) {
    try {
      (void)camera_named(frame, sources);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_TRUE(contains(refused("camera", {left, right}), "left, right"));
  EXPECT_TRUE(contains(refused("lift", {left, right}), "left, right"));
  EXPECT_TRUE(contains(refused("camera", {ball}), "no source is a camera"));
  EXPECT_TRUE(contains(refused("ball", {ball, left}), "a cloud"));
}

// A camera that looks along the world's -x, with its up along z: what is right of it is the world's
// y.
TEST(DevicePlacement, AxesFollowACamerasPictureAndTheOffsetThem) {
  Scene scene;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, 0, -1,  //
      1, 0, 0,                //
      0, -1, 0;
  ASSERT_NEAR(pose.linear().determinant(), 1, 1e-12);
  scene.add("other", SourceOptions{});
  scene.add("front", SourceOptions{}).set_pose(pose);
  Workspace workspace;
  workspace.T_world_device.translation() = Vector3d(1, 2, 3);
  workspace.scale = 2;
  place(workspace, {.offset = {0.1, 0.2, 0.3}, .frame = "front"}, scene);
  const Vector3d origin = workspace.position_to_world({0, 0, 0});
  EXPECT_TRUE(origin.isApprox(Vector3d(1 - 0.2, 2 + 0.1, 3 + 0.3), 1e-12)) << origin.transpose();
  const auto way = [&](const Vector3d& v) { return workspace.velocity_to_world(v); };
  EXPECT_TRUE(way({1, 0, 0}).isApprox(Vector3d(0, 2, 0), 1e-12)) << "to the right";
  EXPECT_TRUE(way({0, 1, 0}).isApprox(Vector3d(-2, 0, 0), 1e-12)) << "away";
  EXPECT_TRUE(way({0, 0, 1}).isApprox(Vector3d(0, 0, 2), 1e-12)) << "up";
  Workspace straight;
  place(straight, {.offset = {0.1, 0.2, 0.3}}, scene);
  EXPECT_EQ(straight.T_world_device.linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(straight.T_world_device.translation(), Vector3d(0.1, 0.2, 0.3));
}

}  // namespace
}  // namespace palpate::app
