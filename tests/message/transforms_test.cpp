#include "message/transforms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::message {
namespace {

using Eigen::Vector3d;

TransformStamped transform(const std::string& parent, const std::string& child, double stamp,
                           const Vector3d& at, const Quaternion& rotation = {}) {
  return {{to_time(stamp), parent}, child, {vector_of(at), rotation}};
}

TEST(Transforms, ChainFramesUpAndDownTheTree) {
  Transforms known;
  known.add({{transform("world", "base", 0, {1, 0, 0}), transform("base", "camera", 0, {0, 2, 0}),
              transform("/world", "/table", 0, {0, 0, 5})}},
            true);
  EXPECT_EQ(known.find("world", "camera", 7)->translation(), Vector3d(1, 2, 0));
  EXPECT_EQ(known.find("table", "camera", 7)->translation(), Vector3d(1, 2, -5));
  EXPECT_EQ(known.find("camera", "camera", 7)->translation(), Vector3d::Zero());
}

TEST(Transforms, AreInterpolatedStraightAndBySlerp) {
  Transforms known;
  const double half = std::sqrt(0.5);
  known.add({{transform("world", "camera", 10, {0, 0, 0})}}, false);
  known.add({{transform("world", "camera", 10.1, {1, 0, 0}, {0, 0, half, half})}}, false);
  const auto found = known.find("world", "camera", 10.05);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->translation().x(), 0.5, 1e-6);
  EXPECT_NEAR(Eigen::AngleAxisd(found->linear()).angle(), std::numbers::pi / 4, 1e-6);
}

TEST(Transforms, AreNotGuessedBeforeAfterAndInGaps) {
  Transforms known;
  known.add(
      {{transform("world", "camera", 10, {0, 0, 0}), transform("world", "camera", 11, {1, 0, 0})}},
      false);
  std::string why;
  EXPECT_FALSE(known.find("world", "camera", 9.9, &why));
  EXPECT_THAT(why, testing::HasSubstr("camera"));
  EXPECT_FALSE(known.find("world", "camera", 11.1));
  EXPECT_FALSE(known.find("world", "camera", 10.5));
  EXPECT_TRUE(known.find("world", "camera", 11));
  EXPECT_FALSE(known.find("world", "elsewhere", 11, &why));
  EXPECT_THAT(why, testing::HasSubstr("elsewhere"));
}

TEST(Transforms, AreInterpolatedOverHalfASecondAndNoMore) {
  Transforms known;
  known.add(
      {{transform("world", "camera", 10, {0, 0, 0}), transform("world", "camera", 10.5, {1, 0, 0}),
        transform("world", "camera", 11.001, {2, 0, 0})}},
      false);
  EXPECT_TRUE(known.find("world", "camera", 10.25));
  EXPECT_FALSE(known.find("world", "camera", 10.75));
}

TEST(Transforms, LeaveOutWhatIsNoPoseOrMakesNoTree) {
  Transforms known;
  const double none = std::numeric_limits<double>::quiet_NaN();
  known.add(
      {{transform("a", "b", 0, {none, 0, 0}), transform("a", "c", 0, {0, 0, 0}, {0, 0, 0, 0.5}),
        transform("a", "a", 0, {0, 0, 0}), transform("", "d", 0, {0, 0, 0})}},
      true);
  for (const char* child : {"b", "c", "d"}) EXPECT_FALSE(known.find("a", child, 0)) << child;
  known.add({{transform("x", "y", 0, {1, 0, 0}), transform("y", "z", 0, {1, 0, 0}),
              transform("z", "x", 0, {1, 0, 0})}},
            true);
  EXPECT_TRUE(known.find("x", "z", 0));  // the last would have closed a loop
}

TEST(Transforms, SayWhichTransformIsNoPose) {
  Transforms known;
  std::string why;
  known.add({{transform("odom", "base", 0, {0, 0, 0}),
              transform("base", "cam", 0, {1, 0, 0}, {0, 0, 0, 0})}},
            true);
  for (const auto& [to, from] : {std::pair("odom", "cam"), std::pair("cam", "odom")}) {
    EXPECT_FALSE(known.find(to, from, 0, &why));
    EXPECT_THAT(why, testing::HasSubstr("from cam to base"));
    EXPECT_THAT(why, testing::HasSubstr("quaternion is all zeros"));
  }
  known.add({{transform("base", "cam", 0, {1, 0, 0}, {0, 0, 0, 2})}}, true);
  EXPECT_FALSE(known.find("odom", "cam", 0, &why));
  EXPECT_THAT(why, testing::HasSubstr("quaternion (0, 0, 0, 2)"));
  known.add({{transform("base", "cam", 0, {1, 0, 0})}}, true);
  EXPECT_TRUE(known.find("odom", "cam", 0));
}

TEST(Transforms, SayWhichTransformOfAMovingFrameIsNoPose) {
  Transforms known;
  std::string why;
  known.add({{transform("world", "cam", 1, {1, 0, 0})}}, false);
  known.add({{transform("world", "cam", 2, {1, 0, 0}, {0, 0, 0, 0})}}, false);
  EXPECT_FALSE(known.find("world", "cam", 2, &why));
  EXPECT_THAT(why, testing::HasSubstr("quaternion is all zeros"));
  EXPECT_TRUE(known.find("world", "cam", 1));
}

TEST(Transforms, KeepTenSecondsAndBeginAgainAfterAJumpBack) {
  Transforms known;
  for (int i = 0; i <= 300; ++i)
    known.add({{transform("w", "c", 0.1 * i, {0.1 * i, 0, 0})}}, false);
  EXPECT_FALSE(known.find("w", "c", 19));
  EXPECT_TRUE(known.find("w", "c", 21));
  known.add({{transform("w", "c", 1, {1, 0, 0})}}, false);
  EXPECT_FALSE(known.find("w", "c", 25));
  EXPECT_TRUE(known.find("w", "c", 1));
}

TEST(Transforms, TurnTimesIntoStampsAndBack) {
  EXPECT_EQ(to_seconds(to_time(1.5)), 1.5);
  EXPECT_EQ(to_time(-1).sec, 0);
  EXPECT_EQ(to_time(std::numeric_limits<double>::quiet_NaN()).sec, 0);
  EXPECT_EQ(to_time(1e300).sec, 0);
  EXPECT_NEAR(to_seconds(to_time(1.7e9 + 0.123)), 1.7e9 + 0.123, 1e-6);
}

}  // namespace
}  // namespace palpate::message
