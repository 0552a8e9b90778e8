// The ways of a robot that holds a tool: a turn is one, all of it is seen, and so is the way back.
#include <algorithm>
#include <numbers>

#include "ros/robot_tool_rig.hpp"

namespace palpate::ros {
namespace {

// A post stands 32 mm from the handle, between where the tool is and where it is to be.
TEST_F(ARobotWithATool, TurnsNoWayThatIsNotSeenFree) {
  sees([](double x, double y) { return std::hypot(x - 0.05, y - 0.05) < 0.012 ? 0.4 : 0.5; });
  // The camera's y is the world's -y.
  box_at({0, 0, 0.05});
  ASSERT_TRUE(looks(0.6).target);
  guide_->pause();
  const double quarter = std::numbers::pi / 2;
  box_at({0, 0, 0.05}, turned(-quarter));
  EXPECT_EQ(looks(1).why, "the way to the tool is not seen free");
  box_at({0, 0, 0.05}, turned(quarter));
  const RobotGuide::Answer round = looks(1);
  ASSERT_TRUE(round.target) << round.why;
  EXPECT_EQ(round.target->orientation.coeffs(), turned(quarter).coeffs());
}

// Half a turn and 0.1 m are a way of 0.23 m, on which more places are to be seen than a look has
// time for.
TEST_F(ARobotWithATool, GoesNoWayThatIsTooLongToBeLookedAt) {
  box_at({-0.05, 0, 0.03});
  ASSERT_TRUE(runs(0.6).target);
  guide_->pause();
  box_at({0.05, 0, 0.03}, turned(std::numbers::pi));
  EXPECT_EQ(runs(1).why, "the tool has to come back to where the robot is");
  box_at({0.05, 0, 0.03});
  EXPECT_TRUE(runs(kLook).target) << "half as far";
  box_at({-0.05, 0, 0.03}, turned(std::numbers::pi));
  EXPECT_FALSE(runs(kLook).target);
  EXPECT_TRUE(runs(kLook, true).target) << "the user sees the way";
}

TEST_F(ARobotWithATool, GoesBackTurnedAsItIsFromWhatComesOverAPartOfIt) {
  box_at({0, 0, 0.03});
  ASSERT_TRUE(runs(0.9).target);
  const double began = now_;
  std::optional<Pose> last;
  for (; now_ < began + 2; now_ += kFrame) {
    // Under one end of the tool something rises, to 50 mm.
    const double height = std::min(0.8 * kRetreat * (now_ - began), 0.05);
    const auto step = [&](double x, double) { return x > 0.05 ? 0.5 - height : 0.5; };
    (void)cameras_.front().source->push(frame_of(small_camera(), now_, step),
                                        [this] { return now_ + 0.01; });
    const RobotGuide::Answer answer = guide_->look(state_, now_, false);
    if (!answer.retreats) continue;
    last = answer.target;
    EXPECT_LT(height - (last->position.z() - 0.005), kNoise);
  }
  ASSERT_TRUE(last);
  EXPECT_NEAR(last->position.z() - 0.005, 0.05, 0.008);
  EXPECT_EQ(last->orientation.coeffs(), Quaterniond::Identity().coeffs());
}

// Back along its ray an end of it leaves the picture. A target that was not told is nowhere: the
// robot is still where the surface comes over it.
TEST_F(ARobotWithATool, IsStillWhereItWasToldLastWhereItCannotGoBackAsSeen) {
  double height = 0;
  camera("comes", [&](double) { return height; });
  starts({"comes"});
  box_at({0.06, 0, 0.02});
  ASSERT_TRUE(runs(0.9).target);
  int back = 0;
  each_ = [&](const RobotGuide::Answer& answer) { back += answer.retreats ? 1 : 0; };
  while (height < 0.044) {
    height += 0.8 * kRetreat * kFrame;
    runs(kFrame);
  }
  EXPECT_GT(back, 0);
  back = 0;
  const RobotGuide::Answer stays = runs(0.5);
  EXPECT_EQ(back, 0);
  EXPECT_THAT(stays.why, HasSubstr("over the tool"));
}

TEST(RobotShape, CountsATurnAsTheWayOfItsFarthestPart) {
  const RobotShape box = box_shape();
  const double lever = Vector3d(0.04, 0.01, 0.005).norm();
  const Pose from;
  const Pose to{{0, 0, 0.01}, turned(0.5)};
  EXPECT_NEAR(box.way(from, to), 0.01 + 0.5 * lever, 1e-12);
  EXPECT_NEAR(RobotShape(0.01).way(from, to), 0.01, 1e-12) << "a ball goes nowhere by a turn";
  const Pose half = RobotShape::between(from, to, 0.5);
  EXPECT_NEAR(box.way(from, half), 0.5 * box.way(from, to), 1e-12);
  EXPECT_NEAR(half.orientation.angularDistance(turned(0.25)), 0, 1e-12);
}

}  // namespace
}  // namespace palpate::ros
