// What a robot is told where cameras see nothing, are silent, or there is none.
#include <gmock/gmock.h>

#include "palpate/base/error.hpp"
#include "ros/robot_rig.hpp"

namespace palpate::ros {
namespace {

using ::testing::HasSubstr;

TEST_F(ARobot, WaitsWhereNothingIsMeasured) {
  camera("camera", [](double t) { return t < 1 ? 0 : 1; });
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(1).target);
  const RobotGuide::Answer answer = runs(0.5);
  EXPECT_FALSE(answer.target);
  EXPECT_THAT(answer.why, HasSubstr("nothing is measured where the tool is"));
}

TEST_F(ARobot, WaitsOutOfThePicture) {
  camera("camera", at_rest);
  starts();
  tool_at({0.5, 0, 0.2});
  EXPECT_THAT(runs(0.5).why, HasSubstr("no camera sees where the tool is"));
}

TEST_F(ARobot, WaitsWhereACameraThatLooksThereIsSilent) {
  camera("one", at_rest);
  camera("two", at_rest);
  starts();
  tool_at({0, 0, 0.1});
  ASSERT_TRUE(runs(1).target);
  cameras_.back().on = false;
  const RobotGuide::Answer answer = runs(0.5);
  EXPECT_FALSE(answer.target);
  EXPECT_THAT(answer.why, HasSubstr("shows nothing new (two, "));
}

// What begins to move where a frame is lost is told by the next one that comes.
TEST_F(ARobot, WaitsForALostFrame) {
  camera("camera", at_rest);
  starts();
  presses_at(0);
  for (int k = 0; k < 40; ++k) {
    cameras_.back().on = k % 5 != 1 && k % 5 != 3;
    runs(kFrame);
  }
  cameras_.back().on = true;
  ASSERT_TRUE(runs(2 * kFrame).target);
  cameras_.back().on = false;
  EXPECT_THAT(runs(1.9 * kFrame).why, HasSubstr("shows nothing new (camera, "));
  cameras_.back().on = true;
  EXPECT_TRUE(runs(kFrame).target) << "at once";
}

TEST_F(ARobot, GoesOnAtOnceAfterASlowCameraLostTwoFrames) {
  camera("camera", at_rest);
  cameras_.back().every = 6;  // 5 Hz
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(2.05).target);
  cameras_.back().on = false;
  EXPECT_FALSE(runs(0.4).target);
  cameras_.back().on = true;
  EXPECT_TRUE(runs(0.2).target);
}

// The robot itself is behind what came meanwhile; the way out to the front is short.
TEST_F(ARobot, FollowsToTheFrontOfWhatCameALittleWhileAFrameWasLost) {
  camera("camera", [](double t) { return t < 1.01 ? 0 : 0.008; });
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(1).target);
  cameras_.back().on = false;
  ASSERT_FALSE(runs(2 * kFrame).target);
  cameras_.back().on = true;
  const RobotGuide::Answer answer = runs(1.1 * kFrame);
  ASSERT_TRUE(answer.target) << answer.why;
  EXPECT_NEAR(answer.target->position.z(), 0.008, 1e-3);
}

TEST_F(ARobot, WaitsWhereACameraHasEnded) {
  Source& source = camera("camera", at_rest);
  starts();
  tool_at({0, 0, 0.1});
  ASSERT_TRUE(runs(1).target);
  cameras_.back().on = false;
  source.keep();
  const RobotGuide::Answer answer = runs(0.5);
  EXPECT_FALSE(answer.target);
  EXPECT_THAT(answer.why, HasSubstr("shows nothing new (camera, "));
}

TEST_F(ARobot, AsksOnlyTheCamerasThatItIsToldToAsk) {
  camera("one", at_rest);
  camera("two", at_rest);
  starts({"one"});
  tool_at({0, 0, 0.1});
  ASSERT_TRUE(runs(1).target);
  cameras_.back().on = false;
  EXPECT_TRUE(runs(0.5).target);
  EXPECT_THROW(starts({"three"}), Error);
}

TEST_F(ARobot, FollowsAtOnceWhenTheButtonIsPressedAnew) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, -0.03});
  ASSERT_FALSE(runs(1).target);
  tool_at({0, 0, 0.05});
  EXPECT_TRUE(runs(kLook, true).target);
  tool_at({0, 0, -0.03});
  EXPECT_FALSE(runs(kLook, true).target) << "not where it is behind something";
}

TEST_F(ARobot, GoesNoWayThatIsNotSeenFree) {
  Source& source = scene_.add("camera", {.T_world_sensor = looking_down()});
  starts();
  // A wall 20 mm thick and 0.1 m high stands between two places.
  const auto sees = [](double x, double) { return std::abs(x) < 0.025 ? 0.4 : 0.5; };
  const auto look_at = [&](const Vector3d& place) {
    (void)source.push(frame_of(small_camera(), now_, sees), [this] { return now_ + 0.01; });
    tool_at(place);
    now_ += kFrame;
    return guide_->look(state_, now_, false);
  };
  ASSERT_TRUE(look_at({-0.05, 0, 0.05}).target);
  guide_->pause();
  RobotGuide::Answer answer;
  for (int k = 0; k < 20; ++k) {  // longer than half a second
    answer = look_at({0.05, 0, 0.05});
    EXPECT_FALSE(answer.target);
  }
  EXPECT_EQ(answer.why, "the way to the tool is not seen free");
  EXPECT_TRUE(look_at({-0.05, 0, 0.2}).target);
  EXPECT_TRUE(look_at({0.05, 0, 0.05}).target) << "a way that was gone is not asked for";
}

// A rod of 4 mm stands between places 9 mm apart, higher than a surface comes slowly.
TEST_F(ARobot, GoesNoShortWayThroughWhatIsHigh) {
  Source& source = scene_.add("camera", {.T_world_sensor = looking_down()});
  starts();
  const auto sees = [](double x, double) { return std::abs(x) < 0.005 ? 0.4 : 0.5; };
  const auto look_at = [&](const Vector3d& place) {
    (void)source.push(frame_of(small_camera(), now_, sees), [this] { return now_ + 0.01; });
    tool_at(place);
    now_ += kFrame;
    return guide_->look(state_, now_, false);
  };
  ASSERT_TRUE(look_at({-0.0049, 0, 0.05}).target);
  EXPECT_EQ(look_at({0.0049, 0, 0.05}).why, "the way to the tool is not seen free");
}

TEST_F(ARobot, FollowsOnCloudsUntilASurfaceLetsTheToolGo) {
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.positions.emplace_back(1e-2f * static_cast<float>(i % 20),
                                 1e-2f * static_cast<float>(i / 20), 0.f);
  }
  scene_.add("cloud", cloud);
  starts();
  tool_at({0, 0, 0.1});
  EXPECT_TRUE(runs(0.1).target);
  state_.contact.notes = ContactNote::reanchored;
  EXPECT_FALSE(runs(kLook).target);
  state_.contact.notes = ContactNote::none;
  EXPECT_TRUE(runs(kLook).target) << "a surface that moved a little is no reason to stop";
  for (const ContactNote note : {ContactNote::freed, ContactNote::inside}) {
    state_.contact.notes = note;
    EXPECT_FALSE(runs(kLook).target);
    state_.contact.notes = ContactNote::none;
    EXPECT_FALSE(runs(0.45).target);
    EXPECT_TRUE(runs(0.1).target);
  }
  state_.field_notes = FieldNote::behind;
  EXPECT_FALSE(runs(1).target);
  state_.field_notes = FieldNote::none;
  tool_at({0, 0, 0.2});
  EXPECT_THAT(runs(1).why, HasSubstr("come back to where the robot is"));
  tool_at({0, 0, 0.11});
  EXPECT_TRUE(runs(kLook).target);
}

TEST_F(ARobot, WaitsWhereACloudIsNotPreparedYet) {
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.positions.emplace_back(1e-2f * static_cast<float>(i % 20),
                                 1e-2f * static_cast<float>(i / 20), 0.f);
  }
  scene_.add("cloud", cloud);
  for (const bool seen : {false, true}) {
    if (seen) camera("camera", at_rest);
    starts();
    state_.field_notes = FieldNote::none;
    tool_at({0, 0, 0.1});
    ASSERT_TRUE(runs(1).target) << seen;
    state_.field_notes = FieldNote::not_loaded;
    EXPECT_EQ(runs(kLook).why, "the cloud is not prepared yet where the tool is") << seen;
    tool_at({0, 0, 0.13});
    EXPECT_FALSE(runs(kLook, true).target) << "nor when the button is pressed anew";
    state_.field_notes = FieldNote::none;
    EXPECT_EQ(runs(1).target.has_value(), seen) << "only a camera sees that the way is free";
    tool_at({0, 0, 0.1});
    EXPECT_TRUE(runs(1).target) << seen;
  }
}

TEST_F(ARobot, WaitsForACameraThatHasShownNothingYet) {
  camera("one", at_rest);
  camera("two", at_rest);
  cameras_.back().on = false;
  starts();
  tool_at({0, 0, 0.1});
  EXPECT_THAT(runs(0.5).why, HasSubstr("(two)"));
  cameras_.back().on = true;
  EXPECT_TRUE(runs(1).target);
}

TEST_F(ARobot, BelievesTheCameraThatSawSomethingComeRatherThanAnOlderFrame) {
  camera("slow", at_rest);
  camera("quick", [](double t) { return t < 1 ? 0 : 0.04; });
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(1).target);
  cameras_.front().on = false;  // its last frame is valid for two more frames
  EXPECT_FALSE(runs(0.05).target);
}

// Tool and robot are 50 mm apart when a wall comes over both.
TEST_F(ARobot, BelievesNoOlderFrameOfTheToolWhileItWaitsElsewhere) {
  camera("slow", at_rest);
  cameras_.back().every = 6;  // 5 Hz: a frame is valid for 0.31 s
  camera("quick", [](double t) { return t < 1.01 ? 0 : 0.3; });
  starts();
  tool_at({0, 0, 0.05});
  ASSERT_TRUE(runs(1.02).target);
  cameras_.front().on = false;
  EXPECT_FALSE(runs(0.04).target);
  tool_at({0.05, 0, 0.05});
  EXPECT_FALSE(runs(0.19).target) << "the quick one sees it come there, and then stay";
  EXPECT_THAT(runs(0.02).why, HasSubstr("something came between camera and tool"));
  EXPECT_FALSE(runs(kLook, true).target) << "the slow one's last frame is older";
}

TEST_F(ARobot, NeedsAllOfABallFree) {
  camera("camera", at_rest);
  guide_.emplace(scene_, RosBridgeOptions::Robot{.preset = "crisp"}, RobotShape(0.02));
  tool_at({0, 0, 0.022});
  EXPECT_TRUE(runs(0.5).target);
  tool_at({0, 0, 0.012});
  EXPECT_GT(runs(0.1).target.value().position.z(), 0.015)
      << "in front of it, as far as noise lets tell";
  tool_at({0, 0, 0});
  EXPECT_FALSE(runs(0.1).target);
}

// A bit of a ball's rim is not measured. It goes back from what is foreseen of the rest between the
// frames of a slow camera.
TEST_F(ARobot, GoesBackThoughABitOfABallIsNotMeasured) {
  constexpr double kSlow = 0.2;  // s between frames
  Source& source = scene_.add("camera", {.T_world_sensor = looking_down()});
  guide_.emplace(scene_, RosBridgeOptions::Robot{.preset = "crisp", .retreat = kRetreat},
                 RobotShape(0.02));
  tool_at({0, 0, 0.03});
  int back = 0;
  double deepest = 0;
  const auto sees = [&](const DepthOf& depth, double height) {
    (void)source.push(frame_of(small_camera(), now_, depth), [this] { return now_ + 0.01; });
    for (const double end = now_ + kSlow; now_ < end; now_ += kLook) {
      const RobotGuide::Answer answer = guide_->look(state_, now_, false);
      if (!answer.retreats) continue;
      ++back;
      deepest = std::max(deepest, height - (answer.target->position.z() - 0.02));
    }
  };
  for (int k = 0; k < 10; ++k) sees(wall(0.5), 0);
  ASSERT_TRUE(guide_->look(state_, now_, false).target);
  for (int k = 1; k <= 8; ++k) {
    const double height = 0.8 * kRetreat * kSlow * k;
    const double depth = 0.5 - height;
    sees([&](double x, double) { return x * depth > 0.014 ? 0 : depth; }, height);
  }
  EXPECT_GT(back, 20);
  EXPECT_LT(deepest, kNoise);
}

TEST_F(ARobot, FollowsTheHandItselfWhereItIsTold) {
  camera("camera", at_rest);
  guide_.emplace(scene_, RosBridgeOptions::Robot{.preset = "crisp", .hand = true}, RobotShape(0));
  presses_at(0, 0.03);
  EXPECT_EQ(place_of(runs(0.5)), Vector3d(0, 0, -0.03));
}

}  // namespace
}  // namespace palpate::ros
