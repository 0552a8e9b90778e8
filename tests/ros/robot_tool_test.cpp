// What a robot that holds a tool is told: all of the tool has to be seen free.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "ros/robot_tool_rig.hpp"

namespace palpate::ros {
namespace {

TEST_F(ARobotWithATool, GoesWhereTheToolIsAndTurnsAsItDoes) {
  box_at({0, 0, 0.1}, tilted(0.3));
  const RobotGuide::Answer free = runs(0.5);
  ASSERT_TRUE(free.target);
  EXPECT_EQ(free.target->position, Vector3d(0, 0, 0.1));
  EXPECT_EQ(free.target->orientation.coeffs(), tilted(0.3).coeffs());
  box_at({0, 0, 0.005});
  presses_at(0.005);
  const RobotGuide::Answer flat = runs(1);
  ASSERT_TRUE(flat.target) << flat.why;
  EXPECT_NEAR(flat.target->position.z(), 0.005, 1e-6) << "it lies on the wall";
}

// The handle is free, and so are nearly all of the samples.
TEST_F(ARobotWithATool, DoesNotBeginWithACornerInTheWall) {
  for (const double angle : {0.2, -0.5}) {
    starts();
    box_at({0, 0, below(std::abs(angle)) - 0.008}, tilted(angle));
    const RobotGuide::Answer answer = runs(1);
    EXPECT_FALSE(answer.target);
    EXPECT_THAT(answer.why, HasSubstr("behind what a camera sees"));
    box_at({0, 0, below(std::abs(angle)) + 1e-3}, tilted(angle));
    EXPECT_TRUE(runs(0.6).target);
  }
}

TEST_F(ARobotWithATool, IsLiftedByAsMuchAsItsCornerIsInTheWall) {
  const double in_front = below(0.5);
  box_at({0, 0, in_front + 1e-3}, tilted(0.5));
  ASSERT_TRUE(runs(0.5).target);
  box_at({0, 0, in_front - 0.008}, tilted(0.5));
  const RobotGuide::Answer lifted = runs(0.1);
  ASSERT_TRUE(lifted.target) << lifted.why;
  EXPECT_NEAR(lifted.target->position.z(), in_front, 1.5e-3);
  EXPECT_EQ(lifted.target->orientation.coeffs(), tilted(0.5).coeffs());
  box_at({0, 0, in_front - 0.02}, tilted(0.5));
  EXPECT_FALSE(runs(0.1).target) << "nothing comes so far in a frame";
}

TEST_F(ARobotWithATool, WaitsWhereAnyPartIsOutOfThePictureOrNotMeasured) {
  box_at({0.03, 0, 0.1});
  EXPECT_TRUE(runs(0.5).target);
  box_at({0.06, 0, 0.1});  // its handle is seen to be free
  EXPECT_THAT(runs(1).why, HasSubstr("no camera sees where the tool is"));
  box_at({0, 0, 0.1});
  EXPECT_TRUE(runs(0.6).target);
  sees([](double x, double y) { return std::hypot(x - 0.07, y) < 0.015 ? 0.0 : 0.5; });
  EXPECT_THAT(looks(0.2).why, HasSubstr("nothing is measured where the tool is"));
  box_at({0, 0, 0.1}, turned(std::numbers::pi / 2));
  EXPECT_EQ(looks(1).why, "the way to the tool is not seen free");
  EXPECT_TRUE(looks(kFrame, true).target) << "turned away from the hole";
}

// Solid in front, and not seen behind: neither followed nor gone back from.
TEST_F(ARobotWithATool, StandsStillWhereItIsSolidAndNotAllInThePicture) {
  box_at({0.06, 0, 0.005});
  ASSERT_TRUE(runs(0.5).target);
  box_at({0.08, 0, -0.003});
  each_ = [](const RobotGuide::Answer& answer) { EXPECT_FALSE(answer.target); };
  EXPECT_THAT(runs(1).why, HasSubstr("no camera sees where the tool is"));
}

TEST_F(ARobotWithATool, DoesNotBeginWhileTheHandTurnsItIntoTheWall) {
  box_at({0, 0, 0.01});
  ASSERT_TRUE(runs(0.5).target);
  guide_->pause();
  state_.orientation = tilted(0.5);
  EXPECT_EQ(runs(1).why, "hand and tool have to be free for half a second");
  state_.orientation = Quaterniond::Identity();
  EXPECT_TRUE(runs(0.6).target);
}

// Lifted in front of the wall, its upper end would be one pixel behind a post at the picture's rim.
TEST_F(ARobotWithATool, IsLiftedIntoNothingBesideIt) {
  shape_ = box_shape(0.16);
  starts();
  box_at({0, 0, 0.003});
  ASSERT_TRUE(runs(0.5).target);
  sees([](double x, double) { return x > 0.1627 ? 0.4 : 0.5; });
  box_at({0, 0, -0.003});
  EXPECT_THAT(looks(kFrame).why, HasSubstr("behind what a camera sees"));
  sees(wall(0.5));
  const RobotGuide::Answer lifted = looks(kFrame);
  ASSERT_TRUE(lifted.target) << lifted.why;
  EXPECT_NEAR(lifted.target->position.z(), 0.005, 1.5e-3);
}

// A wall comes nearer than a tool goes that a wrist turns: only that counts as motion of a surface.
TEST_F(ARobotWithATool, TakesAWristsWorkForNoMotionOfTheSurface) {
  box_at({0, 0, 0.005});
  presses_at(0.005);
  state_.contact.drift = {0, 0, 1};
  ASSERT_TRUE(runs(0.5).target);
  box_at({0, 0, -0.01});
  state_.contact.touching = true;
  EXPECT_FALSE(runs(0.1).target);
}

// m that a pose's box is behind what is seen there: 0.5 m, but a block from 0.42 m on beside x = 0.
// Left out is what is beside the block's edge, by less than windows see (two pixels and more).
double behind_the_block(const Pose& pose, const Tool& box) {
  constexpr double kEdge = 0.012;  // of a ray (x, y, 1)
  double behind = 0;
  for (const Tool::Point& sample : box.samples()) {
    const Vector3d x = looking_down().inverse() * box.in_world(sample.position, 0, pose);
    const double side = x.x() / x.z();
    const double seen = std::abs(side) < kEdge || side < 0 ? 0.5 : 0.42;
    behind = std::max(behind, x.z() - seen);
  }
  return behind;
}

TEST_F(ARobotWithATool, IsToldNoPoseWithAPartInWhatTheCameraSees) {
  const Tool dense = Tool::box({0.08, 0.02, 0.01}, 1e-3);
  sees([](double x, double) { return x > 0 ? 0.42 : 0.5; });
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(-1, 1);
  box_at({-0.04, 0, 0.12});
  int told = 0;
  double deepest = 0;
  double proxy = 0;
  for (int k = 0; k < 600; ++k) {
    // Some 10 mm and a quarter of a turn a look; pulled to where it is half in the block.
    Vector3d place = 0.9 * state_.hip + Vector3d(0, 0, 0.009);
    place += 0.01 * Vector3d(some(random), some(random), some(random));
    const Vector3d turn = 0.25 * Vector3d(some(random), some(random), some(random));
    box_at(place, Quaterniond(AngleAxisd(turn.norm(), turn.normalized())) * state_.orientation);
    const RobotGuide::Answer answer = looks(kFrame, k % 10 == 0);
    proxy = std::max(proxy, behind_the_block(state_.tool, dense));
    if (!answer.target) continue;
    ++told;
    deepest = std::max(deepest, behind_the_block(*answer.target, dense));
  }
  EXPECT_GT(told, 100);
  EXPECT_GT(proxy, 0.02) << "what it is protected from";
  EXPECT_LT(deepest, kNoise);
}

// What a step on a cloud left open, or did not look at, is not told.
TEST(ARobotWithAToolOnACloud, WaitsForAStepThatWasCutShortAndForABigTurn) {
  Scene scene;
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.positions.emplace_back(1e-2f * static_cast<float>(i % 20),
                                 1e-2f * static_cast<float>(i / 20), 0.f);
  }
  scene.add("cloud", cloud);
  RobotGuide guide(scene, {.preset = "crisp"}, box_shape());
  ServoState state;
  state.tool.position = state.hip = {0, 0, 0.1};
  double now = 0;
  const auto look = [&] { return guide.look(state, now += kLook, false); };
  EXPECT_TRUE(look().target);
  for (const ContactNote note :
       {ContactNote::sweep_truncated, ContactNote::not_converged, ContactNote::reanchored}) {
    state.contact.notes = note;
    EXPECT_FALSE(look().target);
    state.contact.notes = ContactNote::none;
    EXPECT_TRUE(look().target);
  }
  state.tool.orientation = turned(0.4);  // 16 mm
  EXPECT_TRUE(look().target);
  state.tool.orientation = turned(1);  // 25 mm
  EXPECT_THAT(look().why, HasSubstr("come back to where the robot is"));
}

}  // namespace
}  // namespace palpate::ros
