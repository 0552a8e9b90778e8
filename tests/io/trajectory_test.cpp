#include "palpate/io/trajectory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

Trajectory parse(const std::string& text, const TrajectoryOptions& options = {}) {
  std::istringstream stream(text);
  return read_trajectory(stream, "path.csv", options);
}

std::string message(const std::string& text, const TrajectoryOptions& options = {}) {
  try {
    (void)parse(text, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Trajectory, ReadsColumnsInAnyOrderAmongOthers) {
  const Trajectory rows =
      parse("# by hand\nhip_z,note,t,hip_y,hip_x\n3,a,0,2,1\n\n-3e-3,,0.0025,+2.5,1.5,more\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(rows[1].time, 0.0025);
  EXPECT_EQ(rows[1].position, Eigen::Vector3d(1.5, 2.5, -3e-3));
}

TEST(Trajectory, ReadsWhatSpreadsheetsWrite) {
  const Trajectory rows = parse("\xEF\xBB\xBFt;hip_x;hip_y;hip_z\r\n0;\"1\"; 2 ;3\r\n1;1;2;3\r\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(parse("t\thip_x\thip_y\thip_z\n0\t1\t2\t3\n").size(), 1u);
}

TEST(Trajectory, ReadsHowAToolIsHeldWhereThatIsTold) {
  const std::string header = "t,hip_x,hip_y,hip_z,qx,qy,qz,qw,gripper\n";
  const Trajectory rows = parse(header + "0,1,2,3,0.6,0,0,0.8,0.01\n");
  EXPECT_EQ(rows[0].orientation->coeffs(), Eigen::Vector4d(0.6, 0, 0, 0.8));
  EXPECT_EQ(rows[0].opening, 0.01);
  const Trajectory straight = parse("t,hip_x,hip_y,hip_z\n0,1,2,3\n");
  EXPECT_FALSE(straight[0].orientation || straight[0].opening);
  EXPECT_NE(message("t,hip_x,hip_y,hip_z,qx,qy,qz\n0,1,2,3,0,0,0\n").find("name all of them"),
            std::string::npos);
  EXPECT_NE(message(header + "0,1,2,3,0.6,0,0,0.9,0\n1,1,2,3,1,1,0,0,0\n").find("line 3: qx"),
            std::string::npos);
  EXPECT_NE(message(header + "0,1,2,3,0.6,0,0,0.8,nan\n").find("column 'gripper'"),
            std::string::npos);
}

// How the header's columns hold a tool, and what is said of them.
std::pair<Eigen::Vector4d, std::string> held(const std::string& columns, const std::string& row) {
  std::string said;
  const TrajectoryOptions options{.remark = [&](const std::string& words) { said = words; }};
  const Trajectory rows =
      parse("t,hip_x,hip_y,hip_z," + columns + "\n0,1,2,3," + row + "\n", options);
  const auto turn = rows[0].orientation;
  return {turn ? Eigen::Vector4d(turn->coeffs()) : Eigen::Vector4d::Zero(), said};
}

TEST(Trajectory, AnOrientationMayHaveTheNamesOfOthers) {
  const Eigen::Vector4d turn(0.6, 0, 0, 0.8);
  for (const std::string names :
       {"orientation.x,orientation.y,orientation.z,orientation.w",
        "pose.pose.orientation.x,pose.pose.orientation.y,pose.pose.orientation.z,"
        "pose.pose.orientation.w",
        "/hand/pose/orientation/x,/hand/pose/orientation/y,/hand/pose/orientation/z,"
        "/hand/pose/orientation/w",
        "qx_world_device,qy_world_device,qz_world_device,qw_world_device",
        "quat_x,quat_y,quat_z,quat_w", "QX,QY,QZ,QW"}) {
    EXPECT_EQ(held(names, "0.6,0,0,0.8").first, turn) << names;
    EXPECT_NE(held(names, "0.6,0,0,0.8").second, "") << names;
  }
  EXPECT_EQ(held("qw,qx,qy,qz,orientation.x", "0.8,0.6,0,0,9"), std::pair(turn, std::string()))
      << "the usual names come first";
  for (const std::string names : {"tool_qx,tool_qy,tool_qz,tool_qw", "a,b,c,d", "w,x,y,z",
                                  "roll_rate,pitch_rate,yaw_rate,d", "orientation.x,b,c,d"}) {
    EXPECT_EQ(held(names, "0.6,0,0,0.8").first, Eigen::Vector4d::Zero()) << names;
  }
}

TEST(Trajectory, RollPitchAndYawTurnAboutFixedAxes) {
  const double quarter = std::acos(0.0);
  const auto [turn, said] = held("roll,pitch,yaw", fmt::format("{},0,{}", quarter, quarter));
  // x to y, then y to z about x, then about z.
  EXPECT_LT((turn - Eigen::Vector4d(0.5, 0.5, 0.5, 0.5)).norm(), 1e-12);
  EXPECT_EQ(said, "roll, pitch and yaw taken as radians");
  for (const std::string names :
       {"roll_deg,pitch_deg,yaw_deg", "roll [deg],pitch [deg],yaw [deg]"}) {
    const auto [same, words] = held(names, "90,0,90");
    EXPECT_LT((same - turn).norm(), 1e-12);
    EXPECT_EQ(words, "roll, pitch and yaw in degrees");
  }
}

TEST(Trajectory, SaysWhichOrientationItCannotChoose) {
  const std::string begin = "t,hip_x,hip_y,hip_z,";
  EXPECT_NE(message(begin + "a.qx,a.qy,a.qz,a.qw,b.qx,b.qy,b.qz,b.qw\n").find("two orientations"),
            std::string::npos);
  EXPECT_NE(message(begin + "a_roll,b_roll,pitch,yaw\n").find("two columns of roll"),
            std::string::npos);
  EXPECT_NE(message(begin + "roll_rad,pitch_deg,yaw_rad\n").find("partly in radians"),
            std::string::npos);
  EXPECT_EQ(message(begin + "roll,pitch,yaw_deg\n0,1,2,3,90,0,0\n"), "no error");
  const std::string degrees = begin + "roll,pitch,yaw\n0,1,2,3,90,0,0\n";
  const std::string refused = message(degrees);
  EXPECT_NE(
      refused.find("roll = 90 is more than a turn in radians: write roll_deg,pitch_deg,yaw_deg"),
      std::string::npos);
  EXPECT_EQ(message(begin + "roll_deg,pitch_deg,yaw_deg\n0,1,2,3,90,0,0\n"), "no error");
  EXPECT_EQ(message(begin + "roll_rad,pitch_rad,yaw_rad\n0,1,2,3,90,0,0\n"), "no error");
}

TEST(Trajectory, SaysThatTextIsUtf16) {
  EXPECT_NE(message(std::string("\xff\xfet\0,\0", 6)).find("line 1: this is UTF-16 text"),
            std::string::npos);
}

TEST(Trajectory, NumbersKeepEveryBit) {
  const Trajectory rows = parse("t,hip_x,hip_y,hip_z\n0,0.1,1e-320,637291.12345678912\n");
  EXPECT_EQ(rows[0].position.x(), 0.1);
  EXPECT_EQ(rows[0].position.y(), 1e-320);
  EXPECT_EQ(rows[0].position.z(), 637291.12345678912);
}

TEST(Trajectory, ErrorsNameFileLineAndRemedy) {
  const std::string header = "t,hip_x,hip_y,hip_z\n";
  EXPECT_EQ(message(header + "0,1,2,3\n1,1,x,3\n"),
            "path.csv, line 3: 'x' in column 'hip_y' is not a finite number: correct or remove the "
            "row");
  EXPECT_NE(message(header + "0,nan,2,3\n").find("line 2: 'nan'"), std::string::npos);
  EXPECT_NE(message(header + "0,1,2,inf\n").find("'inf'"), std::string::npos);
  EXPECT_NE(message(header + "0,1e999,2,3\n").find("1e999"), std::string::npos);
  EXPECT_NE(message(header + "0,1,2,\n").find("'hip_z'"), std::string::npos);
  EXPECT_NE(message(header + "0,1,2\n").find("ends before column 'hip_z'"), std::string::npos);
  EXPECT_NE(message(header + "0,1,2,3\n0,1,2,3\n").find("line 3: t = 0 s follows t = 0 s"),
            std::string::npos);
  EXPECT_NE(message(header + "1,1,2,3\n0.5,1,2,3\n").find("times must increase"),
            std::string::npos);
  EXPECT_NE(message("t,x,y,z\n0,1,2,3\n").find("no column 'hip_x'"), std::string::npos);
  EXPECT_NE(message("").find("is empty"), std::string::npos);
  EXPECT_NE(message(header).find("no rows"), std::string::npos);
  EXPECT_NE(message("0,1,2,3\n").find("no column 't'"), std::string::npos);
}

TEST(Trajectory, ForcesAreReadWhereTheyAreAskedForAndThere) {
  const std::string text = "fz,t,hip_x,hip_y,hip_z,fx,fy\n3,0,7,8,9,1,2\n";
  const TrajectoryOptions forces{.forces = true};
  EXPECT_EQ(parse(text, forces)[0].force, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(parse(text)[0].force);
  EXPECT_FALSE(parse("t,hip_x,hip_y,hip_z,fx,fy\n0,7,8,9,1,2\n", forces)[0].force);
  EXPECT_NE(message("t,hip_x,hip_y,hip_z,fx,fy,fz\n0,7,8,9,1,2,nan\n", forces).find("'fz'"),
            std::string::npos);
}

TEST(Trajectory, TextOfOthersIsReadByTheNamesOfItsColumns) {
  const TrajectoryOptions options{
      .columns = {"t", "-", "hip_x", "hip_y", "hip_z", "fx", "fy", "fz"}, .forces = true};
  const Trajectory rows = parse(
      "% probe of a duck\n  0 99  1 2 3  4 5 6\n\n# middle\n0.5, 99, 1, 2, 3.5, 4, 5, 6 % last\n",
      options);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(rows[1].time, 0.5);
  EXPECT_EQ(rows[1].position.z(), 3.5);
  EXPECT_EQ(rows[1].force, Eigen::Vector3d(4, 5, 6));
}

TEST(Trajectory, ErrorsOfTextWithoutAHeaderNameTheLine) {
  const TrajectoryOptions options{.columns = {"t", "hip_x", "hip_y", "hip_z"}};
  EXPECT_EQ(message("0 1 2 3\n\n1 1 2\n", options),
            "path.csv, line 3: 3 values, but 4 columns are named");
  EXPECT_EQ(message("0 1 2 3\n1 1 2 3 4\n", options),
            "path.csv, line 2: 5 values, but 4 columns are named");
  EXPECT_EQ(message(std::string("\x01\0\x02", 3), options),
            "path.csv, line 1: this is not text; convert it to columns first");
  EXPECT_NE(message("0 1 2 3\n", {.columns = {"t", "x", "hip_y", "hip_z"}})
                .find("path.csv: no column 'hip_x': the list of columns must name"),
            std::string::npos);
  EXPECT_NE(message("% nothing\n", options).find("no rows"), std::string::npos);
}

TEST(Trajectory, FileThatIsNotThereIsNamed) {
  EXPECT_THROW((void)read_trajectory("/nowhere/path.csv"), Error);
  EXPECT_THROW((void)read_trajectory("/tmp"), Error);
}

}  // namespace
}  // namespace palpate
