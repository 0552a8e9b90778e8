#include "ros/robot_guide.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "ros/robot_rig.hpp"

namespace palpate::ros {
namespace {

using ::testing::HasSubstr;

TEST_F(ARobot, FollowsInFreeSpaceAndOnTheSurface) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, 0.1});
  EXPECT_EQ(place_of(runs(0.5)), Vector3d(0, 0, 0.1));
  presses_at(0);
  const RobotGuide::Answer pressed = runs(1);
  EXPECT_EQ(place_of(pressed), Vector3d::Zero());
  EXPECT_TRUE(pressed.reason.empty());
}

TEST_F(ARobot, WaitsBehindWhatTheCameraSeesUntilHandAndToolHaveBeenFreeForAWhile) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, -0.03});
  const RobotGuide::Answer behind = runs(1);
  EXPECT_FALSE(behind.target);
  EXPECT_THAT(behind.why, HasSubstr("behind what a camera sees (camera)"));
  presses_at(0.002);
  EXPECT_FALSE(runs(2).target) << "the hand is still behind";
  tool_at({0, 0, 0.05});
  EXPECT_FALSE(runs(0.45).target);
  EXPECT_EQ(place_of(runs(0.1)), Vector3d(0, 0, 0.05));
}

TEST_F(ARobot, DoesNotBeginALittleBehindWhatTheCameraSees) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, -0.006});
  EXPECT_FALSE(runs(1).target);
  tool_at({0, 0, 0.05});
  EXPECT_TRUE(runs(0.6).target);
}

/// Comes on from 1 s on, for 60 mm.
auto coming(double speed) {
  return [speed](double t) { return std::clamp((t - 1) * speed, 0., 0.06); };
}

constexpr double kSlowly = 0.8 * kRetreat;

TEST_F(ARobot, GoesBackSlowlyFromWhereASurfaceCameOverIt) {
  camera("camera", coming(kSlowly));
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(0.9).reason.empty());
  std::optional<Vector3d> before;
  double longest = 0;
  double deepest = 0;
  double last = 0;
  std::string why;
  each_ = [&](const RobotGuide::Answer& answer) {
    if (!answer.retreats) return;
    why = answer.why;
    if (before) longest = std::max(longest, (answer.target->position - *before).norm());
    before = place_of(answer);
    last = answer.target->position.z();
    deepest = std::max(deepest, coming(kSlowly)(pushed_) - last);
  };
  runs(0.6);
  EXPECT_THAT(why, HasSubstr("the surface passed over the tool 0."));
  const RobotGuide::Answer back = runs(2);
  EXPECT_FALSE(back.target) << "it waits in front of the surface";
  EXPECT_NEAR(last, 0.06, 0.008);
  EXPECT_LE(longest, kRetreat * 2 * kFrame);
  EXPECT_LE(deepest, kNoise);
  tool_at({0, 0, 0.1});
  EXPECT_FALSE(runs(0.45).target);
  EXPECT_TRUE(runs(0.1).target);
}

class ARobotBeforeAFastSurface : public ARobot, public ::testing::WithParamInterface<double> {};

TEST_P(ARobotBeforeAFastSurface, StandsStill) {
  const auto height = coming(GetParam());
  camera("camera", height);
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(0.9).reason.empty());
  each_ = [&](const RobotGuide::Answer& answer) {
    const double told = answer.target ? answer.target->position.z() : 1;
    EXPECT_LE(height(pushed_) - told, kNoise) << now_;
  };
  const RobotGuide::Answer over = runs(2);
  EXPECT_FALSE(over.target);
  EXPECT_THAT(over.why, ::testing::AnyOf(HasSubstr("faster than the robot may go back"),
                                         HasSubstr("something came between")));
}

INSTANTIATE_TEST_SUITE_P(Speeds, ARobotBeforeAFastSurface, ::testing::Values(0.1, 0.25, 0.5, 1));

// A third of the frames is lost: what was counted of the half second stays.
TEST_F(ARobot, FollowsAgainThoughFramesAreLost) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, 0.05});
  ASSERT_TRUE(runs(1).target);
  presses_at(-0.03);
  ASSERT_FALSE(runs(0.2).target);
  tool_at({0, 0, 0.05});
  const double lifted = now_;
  double told = 0;
  each_ = [&](const RobotGuide::Answer& answer) {
    if (answer.target && told == 0) told = now_ - lifted;
  };
  for (int k = 0; k < 40; ++k) {
    cameras_.back().on = k % 3 != 0;
    runs(kFrame);
  }
  EXPECT_GT(told, 0.5);
  EXPECT_LT(told, 0.9);
}

// Poses that are a few milliseconds late now and then change nothing; longer gaps do.
TEST_F(ARobot, FollowsAgainThoughPosesOfTheHandAreLate) {
  const auto waits_with_gaps = [this](double gap) {
    const double lifted = now_;
    for (int k = 0; k < 100; ++k) {
      if (runs(0.05).target) break;
      now_ += gap;
      guide_->miss_hand(now_);
    }
    return now_ - lifted;
  };
  camera("camera", at_rest);
  starts();
  for (const double gap : {0.008, 0.03}) {
    SCOPED_TRACE(gap);
    presses_at(-0.03);
    ASSERT_FALSE(runs(0.2).target);
    tool_at({0, 0, 0.05});
    const double waits = waits_with_gaps(gap);
    if (gap < 0.02) {
      EXPECT_LT(waits, 0.65);
    } else {
      EXPECT_GT(waits, 2);
    }
    runs(1);
  }
}

// What came during a pause was not seen to come slowly.
TEST_F(ARobot, DoesNotGoBackFromWhatCameDuringAPause) {
  camera("camera", [](double t) { return t < 1.02 ? coming(kSlowly)(t) : 0.008; });
  starts();
  presses_at(0);
  runs(1.01);
  guide_->pause();
  now_ += 0.1;
  each_ = [](const RobotGuide::Answer& answer) { EXPECT_FALSE(answer.target); };
  EXPECT_THAT(runs(1).why, HasSubstr("something came between"));
}

TEST_F(ARobot, WaitsForTheHalfSecondAfterAPause) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, 0.05});
  ASSERT_TRUE(runs(1).target);
  guide_->pause();
  EXPECT_FALSE(runs(0.45).target);
  EXPECT_TRUE(runs(0.1).target);
}

TEST_F(ARobot, GoesOnBackAfterAFrameWasLost) {
  camera("camera", coming(kSlowly));
  starts();
  presses_at(0);
  bool retreats = false;
  each_ = [&](const RobotGuide::Answer& answer) { retreats = retreats || answer.retreats; };
  runs(1.5);
  ASSERT_TRUE(retreats);
  cameras_.back().on = false;
  const RobotGuide::Answer blind = runs(1.9 * kFrame);
  EXPECT_FALSE(blind.target);
  EXPECT_THAT(blind.why, HasSubstr("shows nothing new (camera, "));
  cameras_.back().on = true;
  retreats = false;
  const RobotGuide::Answer answer = runs(4 * kFrame);
  EXPECT_TRUE(retreats) << answer.why;
}

TEST_F(ARobot, DoesNotGoBackFromWhatCameBetweenAlsoAfterAFrameWasLost) {
  camera("camera", [](double t) { return t < 1 ? 0 : 0.03; });
  starts();
  presses_at(0);
  ASSERT_THAT(runs(1.2).why, HasSubstr("came between"));
  cameras_.back().on = false;
  ASSERT_THAT(runs(3 * kFrame).why, HasSubstr("shows nothing new"));
  cameras_.back().on = true;
  const RobotGuide::Answer answer = runs(1.1 * kFrame);
  EXPECT_THAT(answer.why, HasSubstr("came between"));
  EXPECT_FALSE(answer.retreats);
}

TEST_F(ARobot, StandsStillWhereItIsNotToGoBack) {
  camera("camera", coming(kSlowly));
  guide_.emplace(scene_, RosBridgeOptions::Robot{.preset = "crisp", .retreat = 0}, RobotShape(0));
  presses_at(0);
  const RobotGuide::Answer answer = runs(2);
  EXPECT_FALSE(answer.target);
  EXPECT_THAT(answer.why, HasSubstr("passed over"));
  tool_at({0, 0, 0.1});
  EXPECT_FALSE(runs(1).target) << "the way out is not seen free";
  EXPECT_TRUE(runs(kLook, true).target) << "but the user sees it";
}

TEST_F(ARobot, DoesNotGoBackFromWhatCameWhileNobodyLooked) {
  camera("camera", [](double t) { return t < 1 ? 0 : 0.03; });
  starts();
  tool_at({0, 0, 0.01});
  ASSERT_TRUE(runs(0.9).target);
  guide_->pause();
  now_ = 1.05;
  each_ = [](const RobotGuide::Answer& answer) { EXPECT_FALSE(answer.retreats); };
  EXPECT_THAT(runs(0.5).why, HasSubstr("something came between camera and tool"));
}

TEST_F(ARobot, DoesNotFollowToTheFrontOfWhatSlidesOverATouchedSurface) {
  camera("camera", [](double t) { return t < 1 ? 0 : 0.04; });
  starts();
  presses_at(0);
  state_.contact.drift = {0, 0, 0.1};
  ASSERT_TRUE(runs(0.9).target);
  each_ = [](const RobotGuide::Answer& answer) {
    EXPECT_LT(place_of(answer).value_or(Vector3d::Zero()).z(), 0.01);
  };
  EXPECT_FALSE(runs(1).target);
}

TEST_F(ARobot, StaysWhereItIsWhenSomethingComesBetween) {
  camera("camera", [](double t) { return t > 1 && t < 2 ? 0.3 : 0; });
  starts();
  tool_at({0, 0, 0.05});
  ASSERT_TRUE(runs(0.9).target);
  each_ = [](const RobotGuide::Answer& answer) { EXPECT_FALSE(answer.retreats); };
  const RobotGuide::Answer hidden = runs(0.9);
  EXPECT_THAT(hidden.why, HasSubstr("something came between camera and tool 0."));
  tool_at({0, 0, 0.4});
  now_ = 1.3;
  EXPECT_FALSE(runs(0.6).target) << "the way from behind it is not free";
  EXPECT_TRUE(runs(0.8).target) << "it went away";
}

TEST_F(ARobot, FollowsASurfaceThatComesSlowlyInFrontOfIt) {
  constexpr double kSpeed = 0.2;         // m/s
  constexpr double kLag = 1.9 * kFrame;  // s, of what is felt: 13 mm
  const auto height = [](double t) {
    return 0.5 * kSpeed * std::max(t - 1, 0.) * std::min(t - 1, 1.);
  };
  camera("camera", height);
  starts();
  presses_at(0);
  ASSERT_TRUE(runs(1).target);
  double deepest = 0;
  for (; now_ < 3.5;) {
    presses_at(height(now_ - kLag));
    state_.contact.drift = {0, 0, (height(now_ - kLag) - height(now_ - kLag - 1e-3)) / 1e-3};
    const RobotGuide::Answer answer = runs(kLook);
    ASSERT_TRUE(answer.reason.empty()) << now_ << " " << answer.why;
    deepest = std::max(deepest, height(now_) - answer.target->position.z());
  }
  EXPECT_LT(deepest, 0.7 * kSpeed * kLag) << "less than the proxy";
}

}  // namespace
}  // namespace palpate::ros
