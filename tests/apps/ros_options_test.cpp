#include "apps/palpate/options/ros_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/palpate/cli/errors.hpp"
#include "apps/setup_parsed.hpp"

namespace palpate::app {
namespace {

TEST(Robot, IsReadFromItsPresetAndOptions) {
  const RosBridgeOptions::Robot robot = parse_robot(
      "generic,topic=/goal,frame=base,rate=100,scale=2,origin=1/2/3/0/0/0/1,button=3,follow=hand");
  EXPECT_EQ(robot.preset, "generic");
  EXPECT_EQ(robot.topic, "/goal");
  EXPECT_EQ(robot.frame, "base");
  EXPECT_EQ(robot.rate, 100);
  EXPECT_EQ(robot.scale, 2);
  EXPECT_EQ(robot.T_robot_world.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(robot.dead_man, 3);
  EXPECT_TRUE(robot.hand);
}

TEST(Robot, FollowsTheProxyUnlessToldOtherwise) {
  EXPECT_FALSE(parse_robot("crisp").hand);
  EXPECT_FALSE(parse_robot("crisp,follow=proxy").hand);
}

TEST(Robot, IsToldWhichSourcesCountAndHowFastToGoBack) {
  const std::string robot = "synthetic:sphere camera:simulated --robot crisp ";
  const auto options = [](const std::string& text) { return *planned(text).ros.options().robot; };
  EXPECT_EQ(options(robot).retreat, 0.05);
  EXPECT_TRUE(options(robot).sources.empty());
  const RosBridgeOptions::Robot told =
      options(robot + "--robot-retreat 0 --robot-sources one --robot-sources two");
  EXPECT_EQ(told.retreat, 0);
  EXPECT_THAT(told.sources, testing::ElementsAre("one", "two"));
  for (const char* text : {"--robot-retreat 0.1", "--robot-sources one"}) {
    EXPECT_THAT(
        [&] { planned("camera:simulated " + std::string(text)); },
        testing::ThrowsMessage<UsageError>(testing::HasSubstr("only to runs with --robot")));
  }
}

TEST(Robot, RefusesWhatItCannotBe) {
  const auto refuses = [](const std::string& text, const std::string& words) {
    EXPECT_THAT([&] { static_cast<void>(parse_robot(text)); },
                testing::ThrowsMessage<UsageError>(testing::HasSubstr(words)))
        << text;
  };
  refuses("franka", "'franka'");
  refuses("generic", "topic=");
  refuses("crisp,rate=0", "rate=0");
  refuses("crisp,rate=x", "rate");
  refuses("crisp,speed=1", "'speed=1'");
  refuses("crisp,follow=me", "'follow=me'");
  refuses("crisp,origin=1/2", "origin");
  refuses("crisp,origin=0/0/0/0/0/0/9", "origin");
  refuses("crisp,button=32", "button=32");
  refuses("crisp,ns=", "ns=");
}

}  // namespace
}  // namespace palpate::app
