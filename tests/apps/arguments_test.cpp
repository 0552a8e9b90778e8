#include "apps/palpate/cli/arguments.hpp"

#include <gtest/gtest.h>

#include "apps/palpate/cli/errors.hpp"

namespace palpate::app {
namespace {

TEST(Arguments, CloudsAreNamedAfterTheirFilesUnlessNamed) {
  const auto clouds =
      parse_clouds({"a/bunny.ply.gz", "left=b.pcd", "c/bunny.ply", "-", "synthetic:torus"});
  ASSERT_EQ(clouds.size(), 5u);
  EXPECT_EQ(clouds[0].name, "bunny");
  EXPECT_EQ(clouds[1].name, "left");
  EXPECT_EQ(clouds[1].path, "b.pcd");
  EXPECT_EQ(clouds[2].name, "bunny-2");
  EXPECT_EQ(clouds[3].name, "stdin");
  EXPECT_EQ(clouds[4].name, "torus");
  EXPECT_EQ(parse_clouds({"site/metadata.json"})[0].name, "site");  // a Potree store's
  EXPECT_EQ(parse_clouds({"site/"})[0].name, "site");
}

TEST(Arguments, PathWithAnEqualsSignIsOnlySplitAtAName) {
  EXPECT_EQ(parse_clouds({"some dir/k=3.ply"})[0].path, "some dir/k=3.ply");
  EXPECT_EQ(parse_clouds({"k=3.ply"})[0].path, "3.ply");
}

TEST(Arguments, PoseTurnsAndMoves) {
  const PoseArgument pose = parse_pose("left=1,2,3,0,0,0.7071068,0.7071068");
  EXPECT_EQ(pose.name, "left");
  EXPECT_LT((pose.pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-6);
  EXPECT_NEAR(pose.pose.linear().determinant(), 1, 1e-12);
}

std::string refusal_of_pose(const std::string& numbers) {
  try {
    (void)parse_pose("a=" + numbers);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

TEST(Arguments, APoseMayBeAMatrix) {
  const PoseArgument pose = parse_pose("left=0,-1,0,1, 1,0,0,2, 0,0,1,3, 0,0,0,1");
  EXPECT_LT((pose.pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  const PoseArgument rows = parse_pose("left=0,-1,0,1, 1,0,0,2, 0,0,1,3");
  EXPECT_TRUE(rows.pose.isApprox(pose.pose));
}

TEST(Arguments, AMatrixThatIsNoPoseSaysWhatIsWrong) {
  const auto has = [](const std::string& numbers, const char* what) {
    EXPECT_NE(refusal_of_pose(numbers).find(what), std::string::npos) << refusal_of_pose(numbers);
  };
  has("1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1", "row by row");  // column by column
  has("2,0,0,0, 0,2,0,0, 0,0,2,0", "length 1");
  has("1,0.1,0,0, 0,1,0,0, 0,0,1,0", "right angles");
  has("1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,0,1", "mirrors");
  has("1,0,0,0, 0,1,0,0", "8 numbers are no pose");
}

TEST(Arguments, WrongOnesSayWhatToWrite) {
  EXPECT_THROW((void)parse_pose("1,2,3,0,0,0,1"), UsageError);
  EXPECT_THROW((void)parse_pose("a=1,2,3,0,0,0,1,5"), UsageError);
  EXPECT_THROW((void)parse_pose("a=1,2,3,0,0,0,0"), UsageError);
  EXPECT_THROW((void)parse_pose("a=1,2,x,0,0,0,1"), UsageError);
  EXPECT_THROW((void)parse_point("1,,3", "--viewpoint"), UsageError);
  EXPECT_THROW((void)parse_point("1,2,inf", "--viewpoint"), UsageError);
  EXPECT_THROW((void)parse_intrinsics("0,525,320,240"), UsageError);
  EXPECT_EQ(parse_point("-1, +2,3e-1", "--viewpoint"), Eigen::Vector3d(-1, 2, 0.3));
}

}  // namespace
}  // namespace palpate::app
