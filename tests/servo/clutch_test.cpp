#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "servo/servo_inside.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

const Vector3d kNowhere = Vector3d::Constant(1e9);  // a rest that nobody may ask for

TEST(Clutch, LeavesEveryBitAloneUntilItIsHeld) {
  Clutch clutch;
  const Vector3d hand(0.1, -0.2, 1e-17);
  EXPECT_EQ(clutch.tool(hand, false, kNowhere), hand);
  EXPECT_EQ(clutch.shift(), Vector3d::Zero());
}

TEST(Clutch, ATurnedToolRestsWhileItIsHeldAndTurnsOnFromThere) {
  const auto turned = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY()));
  };
  Clutch clutch;
  const Pose rest{{0, 0, 0.1}, turned(0.3), 0.02};
  const Pose hand{{0, 0, 0.05}, turned(0.1), 0.01};
  EXPECT_EQ(clutch.turned(hand, false, rest).orientation.coeffs(), hand.orientation.coeffs());
  const Pose held = clutch.turned({hand.position, turned(0.9), 0.05}, true, rest);
  EXPECT_EQ(held.orientation.coeffs(), rest.orientation.coeffs());
  EXPECT_EQ(held.opening, 0.02);
  EXPECT_EQ(held.position, hand.position) << "which tool() shifts";
  const Pose released = clutch.turned({hand.position, turned(0.9), 0.05}, false, {});
  EXPECT_LT(released.orientation.angularDistance(rest.orientation), 1e-12);
  EXPECT_NEAR(released.opening, 0.02, 1e-15);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.2, Vector3d::UnitX()));
  const Pose moved = clutch.turned({hand.position, tilt * turned(0.9), 0.06}, false, {});
  EXPECT_LT(moved.orientation.angularDistance(tilt * rest.orientation), 1e-12);
  EXPECT_NEAR(moved.opening, 0.03, 1e-15);
}

TEST(Clutch, ToolRestsWhileItIsHeldAndGoesOnFromThere) {
  Clutch clutch;
  const Vector3d rest(0, 0, 0.05);
  EXPECT_EQ(clutch.tool({0, 0, 0.05}, false, kNowhere), rest);
  EXPECT_EQ(clutch.tool({0, 0, 0.04}, true, rest), rest);
  EXPECT_EQ(clutch.tool({0, 0, -0.05}, true, rest), rest);
  EXPECT_TRUE(clutch.tool({0, 0, -0.04}, false, kNowhere).isApprox(Vector3d(0, 0, 0.06), 1e-15));
  EXPECT_TRUE(clutch.shift().isApprox(Vector3d(0, 0, 0.1), 1e-15));
}

// Hands at random, held and let go at random: the tool never jumps, and goes as the hand does.
TEST(Clutch, ToolNeverJumpsOnAnyWay) {
  constexpr double kRounding = 1e-13;  // m, of places within some metres
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(-5e-3, 5e-3);
    std::bernoulli_distribution toggled(0.05);
    Clutch clutch;
    Vector3d hand(step(random), step(random), step(random));
    Vector3d tool = clutch.tool(hand, false, kNowhere);
    bool held = false;
    for (int i = 0; i < 500; ++i) {
      const Vector3d way(step(random), step(random), step(random));
      hand += way;
      held = held != toggled(random);
      const Vector3d next = clutch.tool(hand, held, tool);
      const Vector3d expected = held ? tool : Vector3d(tool + way);
      ASSERT_LT((next - expected).norm(), kRounding) << "step " << i << " of " << seed;
      tool = next;
    }
    EXPECT_LT((hand + clutch.shift() - tool).norm(), kRounding);
  }
}

TEST(Clutch, HandThatIsNowhereMovesNothing) {
  Clutch clutch;
  static_cast<void>(clutch.tool({0, 0, 0}, true, {0, 0, 1}));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(clutch.tool({0, bad, 0}, true, {0, 0, 1}).allFinite());
    EXPECT_FALSE(clutch.tool({0, bad, 0}, false, kNowhere).allFinite());
  }
  EXPECT_EQ(clutch.shift(), Vector3d(0, 0, 1));
}

}  // namespace

}  // namespace palpate
