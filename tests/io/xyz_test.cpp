#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>

#include "io/formats.hpp"
#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;
using Color = std::array<std::uint8_t, 3>;

TEST(Xyz, ReadsEverySeparator) {
  for (const std::string_view row :
       {"1 2 3", "1\t2\t3", "1\t\t2\t3", "1,2,3", "1;2;3", " 1 , 2 ,\t3 ", "1, 2, 3\r",
        "\"1\",\"2.0\",\"3\"", "1;2;3;", "1D0 20.0d-1 0.3D+01"}) {
    EXPECT_EQ(first_point(read_text(std::string(row) + "\n")), Eigen::Vector3f(1, 2, 3)) << row;
  }
}

TEST(Xyz, SkipsCommentsAndEmptyLines) {
  EXPECT_EQ(read_text("# a\n\n// b\n% c\n1 2 3\n\n# d\n4 5 6").cloud.size(), 2u);
}

TEST(Xyz, TakesColumnsFromAHeaderLine) {
  const CloudFile file = read_text(
      "\"Time\", Y[m],X[m], Z (m),Scalar_Intensity,nx,ny,nz,R,G,B\n7,2,1,3,0.5,0,0,1,10,20,255\n");
  EXPECT_EQ(first_point(file), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(file.cloud.intensities[0], 0.5F);
  EXPECT_EQ(file.cloud.normals[0], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(file.cloud.colors[0], (Color{10, 20, 255}));
  EXPECT_EQ(read_text("//X Y Z Intensity\n1 2 3 9\n").cloud.intensities[0], 9);
}

TEST(Xyz, TellsColumnsFromTheirNumber) {
  EXPECT_EQ(read_text("1 2 3 55\n4 5 6 66\n").cloud.intensities[1], 66);
  EXPECT_EQ(read_text("1 2 3 10 20 30\n").cloud.colors[0], (Color{10, 20, 30}));
  EXPECT_EQ(read_text("1 2 3 0 0.6 -0.8\n").cloud.normals[0], Eigen::Vector3f(0, 0.6F, -0.8F));
  const CloudFile seven = read_text("1 2 3 55 10 20 30\n");
  EXPECT_EQ(seven.cloud.intensities[0], 55);
  EXPECT_EQ(seven.cloud.colors[0], (Color{10, 20, 30}));
  for (const std::string_view row : {"1 2 3 0 0 1 10 20 30\n", "1 2 3 10 20 30 0 0 1\n"}) {
    const CloudFile nine = read_text(row);
    EXPECT_EQ(nine.cloud.normals[0], Eigen::Vector3f(0, 0, 1));
    EXPECT_EQ(nine.cloud.colors[0], (Color{10, 20, 30}));
  }
  const CloudFile five = read_text("1 2 3 4 5\n");
  EXPECT_TRUE(five.cloud.intensities.empty());
  EXPECT_EQ(first_point(five), Eigen::Vector3f(1, 2, 3));
}

TEST(Xyz, ReadsScansOfPtsByTheirCounts) {
  EXPECT_EQ(read_text("2\n1 2 3\n4 5 6\n", "a.pts").cloud.size(), 2u);
  EXPECT_EQ(read_text("2\n1 2 3\n4 5 6\n1\r\n7 8 9\n0\n", "a.pts").cloud.size(), 3u);
  EXPECT_THAT(refusal("3\n1 2 3\n4 5 6\n"),
              HasSubstr("line 1: 2 points follow, but this line declares 3"));
  EXPECT_THAT(refusal("1\n1 2 3\n4 5 6\n1\n7 8 9\n"), HasSubstr("line 1: 2 points follow"));
  EXPECT_THAT(refusal("1\n1 2 3\n2\n7 8 9\n"), HasSubstr("line 3: 1 points follow"));
  EXPECT_THAT(refusal("1 2 3\n4\n7 8 9\n"), HasSubstr("line 2: 1 values in a row"));
}

TEST(Xyz, DropsWhatMicrosoftsRuntimeWritesAsNotFinite) {
  const CloudFile file =
      read_text("1 2 3\n1.#QNAN 0 0\n0 -1.#IND 0\n0 0 1.#INF00\n-1.#IND00 0 0\n");
  EXPECT_EQ(file.cloud.size(), 1u);
  EXPECT_EQ(file.dropped, 4u);
  EXPECT_THAT(refusal("1 2 3\n1.#X 0 0\n"), HasSubstr("\"1.#X\" is not a number"));
}

TEST(Xyz, DropsRowsWithMissingValues) {
  for (const char* text : {"x,y,z\n1,,3\n4,5,6\nnan,0,0\n", "4\t5\t6\n1\t\t3\n\t2\t3\n",
                           "x\ty\tz\n1\t\t3\n4\t5\t6\n1\t2\t\n"}) {
    const CloudFile file = read_text(text);
    EXPECT_EQ(file.cloud.size(), 1u) << text;
    EXPECT_EQ(first_point(file), Eigen::Vector3f(4, 5, 6)) << text;
    EXPECT_EQ(file.dropped, 2u) << text;
  }
}

TEST(Xyz, AMissingValueShiftsNone) {
  const CloudFile file = read_text("1\t2\t3\t7\n4\t5\t6\t8\n1\t\t3\t9\n");
  EXPECT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.dropped, 1u);
  EXPECT_THAT(refusal("1 2 3 7\n4 5 6 8\n1  3 9\n"), HasSubstr("line 3: 3 values in a row"));
  EXPECT_THAT(refusal("1,,3\n4,,6\n"), HasSubstr("line 1"));
}

TEST(Xyz, LeavesOutAByteOrderMark) {
  EXPECT_EQ(first_point(read_text("\xEF\xBB\xBFx,y,z\n1,2,3\n")), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(first_point(read_text("\xEF\xBB\xBF"
                                  "1 2 3\n")),
            Eigen::Vector3f(1, 2, 3));
}

TEST(Xyz, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(refusal("1 2 3\n4 5 6\n7 8\n"),
              HasSubstr("line 3: 2 values in a row, but the first row has 3"));
  EXPECT_THAT(refusal("x y z i\n7 8 9\n"),
              HasSubstr("line 2: 3 values in a row, but the header names 4"));
  EXPECT_THAT(refusal("1 2 3\n4 fünf 6\n"), HasSubstr("line 2: \"f??nf\" is not a number"));
  std::string wide;
  for (int i = 0; i < 4097; ++i) wide += "1 ";
  EXPECT_THAT(refusal(wide), HasSubstr("line 1: more than 4096 columns"));
  EXPECT_THAT(refusal("1 2\n"), HasSubstr("2 columns, but x y z need 3"));
  EXPECT_THAT(refusal("a,b,c\n1,2,3\n"), HasSubstr("neither a point nor a header"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("no line holds numbers"));
  EXPECT_THAT(refusal("x y z\n"), HasSubstr("holds no points"));
  EXPECT_THAT(refusal("Dear reader,\nthis is a letter.\n"),
              HasSubstr("neither a point nor a header"));
}

TEST(Xyz, LinesWithCommasMayEndInOne) {
  EXPECT_EQ(first_point(read_text("x,y,z,\n1,2,3,\n")), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(read_text("x,y,z,i\n1,2,3,\n").cloud.size(), 1u);
}

TEST(Xyz, BlanksThatPadColumnsOfOneWidthSeparateNothing) {
  const PointCloud cloud = read_text("-120,  80,1500, 200\n-110,  85,1510, 210\n").cloud;
  EXPECT_EQ(cloud.point(1), Eigen::Vector3d(-110, 85, 1510));
}

TEST(Xyz, ProseInACommentNamesNoColumns) {
  for (const char* prose : {"# format: x y z\n", "# x, y and z in mm here\n"}) {
    const std::string text = std::string(prose) + "1 2 3 9\n2 2 3 9\n4 5 6 9\n";
    EXPECT_EQ(first_point(read_text(text)), Eigen::Vector3f(1, 2, 3)) << prose;
  }
  EXPECT_EQ(first_point(read_text("#id x y z\n7 1 2 3\n9 1 2 4\n")), Eigen::Vector3f(1, 2, 3));
}

TEST(Xyz, DecimalCommasAreNotTakenForSeparators) {
  for (const char* text : {"1,5;2;-3,25\n", "1,5 2 -3,25\n", "1,5\t2\t-3,25\n", "1,5, 2, -3,25\n",
                           "\"1,5\",\"2\",\"-3,25\"\n", "x, y, z\n1,5, 2,0, -3,25\n"}) {
    EXPECT_EQ(first_point(read_text(text)), Eigen::Vector3f(1.5F, 2, -3.25F)) << text;
    EXPECT_THAT(read_text(text).format, HasSubstr("decimal commas")) << text;
  }
  EXPECT_THAT(refusal("1,05,2,50,3,25\n1,15,2,50,3,25\n"), HasSubstr("within numbers and between"));
  EXPECT_THAT(refusal("x,y,z\n1,5,2,5,3,5\n"),
              HasSubstr("6 values in a row, but the header names 3"));
  EXPECT_THAT(refusal("1,5;2.5;3,5\n"), HasSubstr("is not a number"));
  EXPECT_THAT(refusal("1.000,5;2;3,5\n"), HasSubstr("is not a number"));
}

TEST(Xyz, PlacesHaveManyNames) {
  for (const char* names :
       {"Points:0,Points:1,Points:2", "\"Points:0\",\"Points:1\",\"Points:2\"",
        "EASTING,Northing,h", "Easting [m],Northing [m],Height [m]",
        "Easting (m) Northing (m) Height (m)", "E;N;Up", "X,Y,Elevation", "// X Y Z", "# x y z",
        "sep=,\nx,y,z", "\"X [m]\"\t\"Y [m]\"\t\"Z [m]\""}) {
    EXPECT_EQ(first_point(read_text(std::string(names) + "\n1,2,3\n")), Eigen::Vector3f(1, 2, 3))
        << names;
  }
  EXPECT_EQ(first_point(read_text("Height,x,y,z\n9,1,2,3\n")), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(first_point(read_text("# x y z are in metres\n1 2 3\n")), Eigen::Vector3f(1, 2, 3));
}

TEST(Xyz, AFirstColumnThatCountsTheRowsIsNoCoordinate) {
  for (const char* text : {"0 1 2 3\n1 1 2 4\n2 1 2 5\n3 1 2 6\n",
                           "1,1,2,3,50\n2,1,2,4,60\n3,1,2,5,70\n4,1,2,6,80\n"}) {
    const CloudFile file = read_text(text);
    EXPECT_EQ(first_point(file), Eigen::Vector3f(1, 2, 3)) << text;
    EXPECT_EQ(file.cloud.intensities.empty(), text[0] == '0') << text;
    EXPECT_THAT(file.format, HasSubstr("counts the rows"));
  }
  for (const char* text : {"0 1 2 3\n1 1 2 4\n2 1 2 5\n3 1 2 6\n0 1 2 6\n",
                           "0 1 2\n1 1 2\n2 1 2\n3 1 2\n", "0 1 2 3\n1 1 2 4\n2 1 2 5\n"}) {
    EXPECT_EQ(read_text(text).format, "text") << text;
    EXPECT_EQ(first_point(read_text(text)), Eigen::Vector3f(0, 1, 2)) << text;
  }
  EXPECT_THAT(refusal(",0,1,2\n0,1,2,3\n1,1,2,4\n"), HasSubstr("line 1"));
}

TEST(Xyz, DegreesBecomeMetresAroundTheFirstPoint) {
  const CloudFile file =
      read_text("lat,lon,alt\n60,10,5\n60.001,10,5\n60,10.001,6\n,10,5\n", "a.csv", {.scale = 0.5});
  ASSERT_EQ(file.cloud.size(), 3u);
  EXPECT_LT((file.cloud.point(0) - Eigen::Vector3d(0, 0, 2.5)).norm(), 1e-3);
  EXPECT_LT((file.cloud.point(1) - Eigen::Vector3d(0, 111.412, 2.5)).norm(), 1e-2);
  EXPECT_LT((file.cloud.point(2) - Eigen::Vector3d(55.800, 0, 3)).norm(), 1e-2);
  EXPECT_THAT(file.format, HasSubstr("degrees made metres"));
  EXPECT_THAT(refusal("lat,lon,alt\n60,10,5\n5000,10,5\n"),
              HasSubstr("line 3: a longitude of 10 and a latitude of 5000"));
}

TEST(Xyz, DoesNotDependOnTheLocale) {
  const char* german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_EQ(first_point(read_text("1.5 2.5 3.5\n")), Eigen::Vector3f(1.5F, 2.5F, 3.5F));
  if (german != nullptr) std::setlocale(LC_ALL, "C");
}

TEST(Xyz, ReadsNumbersOfEverySize) {
  const CloudFile file = read_text("+1 -0.0 1e-400\n1e-45 1E+2 .5\n1e400 0 0\n1e13 0 0\n");
  EXPECT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(first_point(file), Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(file.cloud.positions[1].y(), 100);
  EXPECT_EQ(file.dropped, 2u);
}

std::string of_colmap(bool comment) {
  const std::string names =
      "# 3D point list with one line of data per point:\n"
      "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n"
      "# Number of points: 3, mean track length: 2\n";
  return (comment ? names : "") +
         "77 1 2 3 10 20 30 0.5 1 0 2 5\n3 4 5 6 40 50 60 0.1 1 1\n9 7 8 9 1 2 3 0.2 1 2 2 7 3 1\n";
}

TEST(Xyz, ReadsColmapsPointsWhoseTracksAreOfAnyLength) {
  for (const auto& [text, name] :
       {std::pair(of_colmap(true), "a.txt"), std::pair(of_colmap(false), "sparse/points3D.txt")}) {
    const CloudFile file = read_text(text, name);
    ASSERT_EQ(file.cloud.size(), 3u);
    EXPECT_EQ(file.format, "text, columns named");
    EXPECT_EQ(file.cloud.point(1), Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(file.cloud.colors[1], (std::array<std::uint8_t, 3>{40, 50, 60}));
  }
  EXPECT_EQ(read_text("1 2 3\n", "points3D.txt").cloud.size(), 1u);
  EXPECT_NE(refusal("# Image list\n#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
                    "1 1 0 0 0 0 0 0 1 a.png\n")
                .find("COLMAP's list of pictures"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate
