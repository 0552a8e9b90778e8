#include "sensor/pose_track.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "palpate/base/error.hpp"

namespace palpate::sensor {
namespace {

using testing::HasSubstr;

Eigen::Isometry3d pose(double angle, const Eigen::Vector3d& place) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = place;
  return pose;
}

template <class Parse>
std::string refusal(const Parse& parse, const std::string& text) {
  try {
    (void)parse(text, "a.txt");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PoseTrack, InterpolatesInStraightLinesAndAlongTheShortestArc) {
  const double quarter = std::numbers::pi / 2;
  const PoseTrack track{{0, pose(0, {0, 0, 0})}, {0.2, pose(quarter, {1, 2, 3})}};
  EXPECT_TRUE(pose_at(track, 0)->isApprox(pose(0, {0, 0, 0})));
  EXPECT_TRUE(pose_at(track, 0.2)->isApprox(pose(quarter, {1, 2, 3})));
  EXPECT_TRUE(pose_at(track, 0.1)->isApprox(pose(quarter / 2, {0.5, 1, 1.5}), 1e-9));
  EXPECT_TRUE(pose_at(track, 0.05)->isApprox(pose(quarter / 4, {0.25, 0.5, 0.75}), 1e-9));
}

TEST(PoseTrack, TurnsTheShortWayWhateverTheSignOfTheQuaternion) {
  const std::string text = "0 0 0 0  0 0 0 1\n0.1 0 0 0  0 0 -0.7071068 -0.7071068\n";
  const auto track = std::get<PoseTrack>(parse_poses(text, "a.txt"));
  EXPECT_TRUE(pose_at(track, 0.05)->isApprox(pose(std::numbers::pi / 4, {0, 0, 0}), 1e-6));
}

TEST(PoseTrack, KnowsNothingOutsideAndInGaps) {
  const PoseTrack track{
      {1, pose(0, {0, 0, 0})}, {2, pose(1, {1, 0, 0})}, {2.1, pose(1, {2, 0, 0})}};
  EXPECT_FALSE(pose_at(track, 0.99));
  EXPECT_FALSE(pose_at(track, 1.5));
  EXPECT_FALSE(pose_at(track, 2.2));
  EXPECT_FALSE(pose_at({}, 1));
  EXPECT_TRUE(pose_at(track, 0.9995)) << "half a millisecond before";
  EXPECT_TRUE(pose_at(track, 1.0005));
  EXPECT_TRUE(pose_at(track, 2.1005));
}

TEST(Poses, ReadsTum) {
  const auto track = std::get<PoseTrack>(
      parse_poses("# timestamp tx ty tz qx qy qz qw\n1.5 1 2 3 0 0 0 1\n2.5 4 5 6 0 0 1 0\n", "a"));
  ASSERT_EQ(track.size(), 2u);
  EXPECT_EQ(track[1].stamp, 2.5);
  EXPECT_TRUE(track[1].pose->isApprox(pose(std::numbers::pi, {4, 5, 6}), 1e-9));
}

TEST(Poses, ReadsMatricesInOrder) {
  const auto ordered =
      std::get<PosesByOrder>(parse_poses("0 0 1\n1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n"
                                         "3\t3\t4\n 0 -1 0 1\n 1 0 0 2\n 0 0 1 3\n 0 0 0 1\n",
                                         "a"));
  ASSERT_EQ(ordered.poses.size(), 2u);
  EXPECT_TRUE(ordered.poses.at(0).isApprox(pose(0, {5, 6, 7})));
  EXPECT_TRUE(ordered.poses.at(3).isApprox(pose(std::numbers::pi / 2, {1, 2, 3}), 1e-9));
}

TEST(Poses, ReadsMatricesByNumberAndWhatStandsBehindThem) {
  const auto numbered = std::get<PosesByNumber>(
      parse_poses("# Color camera intrinsic matrix\n600 0 300\n0 600 240\n0 0 1\n\n"
                  "# Depth-to-color camera extrinsic matrix\n1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
                  "# Camera-to-world extrinsic matrix (camera pose) for frame-000012\n"
                  "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n",
                  "a"));
  ASSERT_EQ(numbered.poses.size(), 1u);
  EXPECT_TRUE(numbered.poses.at(12).isApprox(pose(0, {5, 6, 7})));
  EXPECT_TRUE(numbered.T_posed_sensor.isApprox(pose(0, {0.1, 0, 0})));
}

TEST(Poses, AreMissingWhereTrackingWasLost) {
  const std::string lost = "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n";
  const std::string known = "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n";
  const auto ordered = std::get<PosesByOrder>(
      parse_poses("0 0 1\n" + lost + "-inf -inf -inf -inf\n1 1 2\n" + known, "a"));
  EXPECT_EQ(ordered.poses.size(), 1u);
  EXPECT_TRUE(ordered.poses.contains(1));
  const auto numbered = std::get<PosesByNumber>(
      parse_poses("# frame-3\n" + lost + "0 0 0 1\n# frame-4\n" + known, "a"));
  EXPECT_EQ(numbered.poses.size(), 1u);
  EXPECT_TRUE(numbered.poses.contains(4));
}

TEST(PoseTrack, KnowsNothingBesideALostPose) {
  const auto track = std::get<PoseTrack>(
      parse_poses("0 nan nan nan nan nan nan nan\n0.1 0 0 0 0 0 0 1\n0.2 1 0 0 0 0 0 1\n"
                  "0.3 -inf 0 0 0 0 0 1\n0.4 2 0 0 0 0 0 1\n",
                  "a"));
  ASSERT_EQ(track.size(), 5u);
  EXPECT_TRUE(pose_at(track, 0.15));
  EXPECT_TRUE(pose_at(track, 0.2));
  for (const double lost : {0.0, 0.05, 0.25, 0.3, 0.35}) EXPECT_FALSE(pose_at(track, lost)) << lost;
}

TEST(Poses, SetsRoundedRotationsRight) {
  const auto ordered = std::get<PosesByOrder>(
      parse_poses("0 0 1\n0.999 0.001 0 0\n0 1.001 0 0\n0 0 1 0\n0 0 0 1\n", "a"));
  const Eigen::Matrix3d rotation = ordered.poses.at(0).linear();
  EXPECT_TRUE((rotation * rotation.transpose()).isIdentity(1e-12));
}

TEST(Poses, NamesTheLineThatIsWrong) {
  EXPECT_THAT(refusal(parse_poses, ""), HasSubstr("unknown pose format"));
  EXPECT_THAT(refusal(parse_poses, "hello\n"), HasSubstr("unknown pose format"));
  EXPECT_THAT(refusal(parse_poses, "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n"), HasSubstr("a.txt, line 2"));
  EXPECT_THAT(refusal(parse_poses, "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr("not later than"));
  EXPECT_THAT(refusal(parse_poses, "1 0 0 0 0 0 0 2\n"), HasSubstr("length is not 1"));
  EXPECT_THAT(refusal(parse_poses, "1 0 0 0 0 0 0 1\nnan 0 0 0 0 0 0 1\n"), HasSubstr("line 2"));
  EXPECT_THAT(
      refusal(parse_poses,
              "# depth-to-color extrinsic\nnan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n# frame-1\n"
              "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"),
      HasSubstr("line 2: this matrix is not finite"));
  EXPECT_THAT(refusal(parse_poses, "0 0 1\n1 0 0 0\n0 1 0 0\n"), HasSubstr("line 4"));
  EXPECT_THAT(refusal(parse_poses, "0 0 1\n1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n"),
              HasSubstr("line 2: this matrix is not a rotation"));
  EXPECT_THAT(refusal(parse_poses, "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n"),
              HasSubstr("not a rotation"));
}

TEST(FrameList, ReadsDepthAndAssociations) {
  const auto depth = parse_frame_list("# a\n\n1.5 depth/a.png\r\n2.5 depth/b.png\n", "a.txt");
  ASSERT_EQ(depth.size(), 2u);
  EXPECT_EQ(depth[0].image, "depth/a.png");
  EXPECT_EQ(depth[1].stamp, 2.5);
  const auto pairs =
      parse_frame_list("1 rgb/a.png 1.1 depth/b.png\n2 depth/c.png 2.1 rgb/d.png\n", "a");
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].image, "depth/b.png");
  EXPECT_EQ(pairs[0].stamp, 1.1);
  EXPECT_EQ(pairs[1].image, "depth/c.png");
}

TEST(FrameList, NamesTheLineThatIsWrong) {
  EXPECT_THAT(refusal(parse_frame_list, "1 a\nx b\n"), HasSubstr("a.txt, line 2"));
  EXPECT_THAT(refusal(parse_frame_list, "1\n"), HasSubstr("line 1"));
  EXPECT_THAT(refusal(parse_frame_list, "1 a 2 b\n"), HasSubstr("under depth/"));
  EXPECT_THAT(refusal(parse_frame_list, "2 a\n1 b\n"), HasSubstr("not later than"));
  EXPECT_THAT(refusal(parse_frame_list, "inf a\n"), HasSubstr("line 1"));
}

}  // namespace
}  // namespace palpate::sensor
