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
       {"1 2 3", "1\t2\t3", "1,2,3", "1;2;3", " 1 , 2 ,\t3 ", "1, 2, 3\r"}) {
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

TEST(Xyz, ReadsTheCountOfPts) {
  EXPECT_EQ(read_text("2\n1 2 3\n4 5 6\n", "a.pts").cloud.size(), 2u);
  EXPECT_THAT(refusal("3\n1 2 3\n4 5 6\n"),
              HasSubstr("has 2 points, but its first line declares 3"));
}

TEST(Xyz, DropsWhatMicrosoftsRuntimeWritesAsNotFinite) {
  const CloudFile file =
      read_text("1 2 3\n1.#QNAN 0 0\n0 -1.#IND 0\n0 0 1.#INF00\n-1.#IND00 0 0\n");
  EXPECT_EQ(file.cloud.size(), 1u);
  EXPECT_EQ(file.dropped, 4u);
  EXPECT_THAT(refusal("1 2 3\n1.#X 0 0\n"), HasSubstr("\"1.#X\" is not a number"));
}

TEST(Xyz, DropsRowsWithMissingValues) {
  const CloudFile file = read_text("x,y,z\n1,,3\n4,5,6\nnan,0,0\n");
  EXPECT_EQ(file.cloud.size(), 1u);
  EXPECT_EQ(file.dropped, 2u);
}

TEST(Xyz, LeavesOutAByteOrderMark) {
  EXPECT_EQ(first_point(read_text("\xEF\xBB\xBFx,y,z\n1,2,3\n")), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(first_point(read_text("\xEF\xBB\xBF"
                                  "1 2 3\n")),
            Eigen::Vector3f(1, 2, 3));
}

TEST(Xyz, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(refusal("1 2 3\n4 5 6\n7 8\n"),
              HasSubstr("line 3: 2 columns, but the first line has 3"));
  EXPECT_THAT(refusal("1 2 3\n4 fünf 6\n"), HasSubstr("line 2: \"f??nf\" is not a number"));
  std::string wide;
  for (int i = 0; i < 65; ++i) wide += "1 ";
  EXPECT_THAT(refusal(wide), HasSubstr("line 1: more than 64 columns"));
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

TEST(Xyz, DecimalCommasAreNotTakenForSeparators) {
  EXPECT_THAT(refusal("1,5;2,5;3,5\n1,5;2,5;3,5\n"), HasSubstr("commas inside numbers"));
  EXPECT_THAT(refusal("1,5 2,5 3,5\n1,5 2,5 3,5\n"), HasSubstr("commas inside numbers"));
  EXPECT_THAT(refusal("1,5\t2,5\t3,5\n"), HasSubstr("commas inside numbers"));
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

}  // namespace
}  // namespace palpate
