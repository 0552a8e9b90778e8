#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

// A scan of one column whose frame is turned by 90 degrees about z and stands at (10, 20, 30).
constexpr std::string_view kByRows = "0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";
constexpr std::string_view kByColumns = "0 -1 0 10\n1 0 0 20\n0 0 1 30\n0 0 0 1\n";

std::string scan(std::size_t rows, std::string_view points, std::string_view matrix = kByRows) {
  return "1\n" + std::to_string(rows) + "\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n" + std::string(matrix) +
         std::string(points);
}

TEST(Ptx, PointsAreWhereTheMatrixLeads) {
  const CloudFile file = read_text(scan(3, "1 2 3 0.5\n0 0 0 0\n4 5 6 0.25\n"));
  EXPECT_EQ(file.format, "PTX");
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_LT((file.cloud.point(0) - Eigen::Vector3d(8, 21, 33)).norm(), 1e-5);
  EXPECT_LT((file.cloud.point(1) - Eigen::Vector3d(5, 24, 36)).norm(), 1e-5);
  EXPECT_EQ(file.cloud.intensities[1], 0.25F);
  EXPECT_EQ(file.dropped, 1u);
  ASSERT_TRUE(file.cloud.viewpoint);
  EXPECT_EQ(*file.cloud.viewpoint, Eigen::Vector3d(10, 20, 30));
}

TEST(Ptx, ScansOfAFileAreOneCloud) {
  const std::string one = scan(1, "1 2 3 0.5 255 128 0\n");
  const CloudFile file = read_text(one + one, "a.ptx", {.scale = 2});
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.cloud.point(1), Eigen::Vector3d(16, 42, 66));
  EXPECT_EQ(file.cloud.colors[1], (std::array<std::uint8_t, 3>{255, 128, 0}));
  EXPECT_FALSE(file.cloud.viewpoint);
}

TEST(Ptx, ScansWithAndWithoutColorsAreOneCloudWithout) {
  const std::string plain = scan(2, "1 2 3 0.5\n0 0 0 0 0 0 0\n");
  const std::string colored = scan(2, "0 0 0 0\n4 5 6 0.25 255 128 0\n");
  for (const std::string& text : {plain + colored, colored + plain}) {
    const CloudFile file = read_text(text, "a.ptx");
    ASSERT_EQ(file.cloud.size(), 2u);
    EXPECT_EQ(file.dropped, 2u);
    EXPECT_TRUE(file.cloud.colors.empty());
    EXPECT_EQ(file.format, "PTX, colours are not used, which 1 points lack");
  }
  EXPECT_EQ(read_text(colored).cloud.colors.size(), 1u) << "what is not seen needs no colour";
}

TEST(Ptx, PointsThatAreLeftOutWhereAnotherScanBeginsAreCounted) {
  const CloudFile file = read_text(scan(5, "1 2 3 0.5\n") + scan(1, "4 5 6 0.5\n"), "a.ptx");
  EXPECT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.format, "PTX, 4 points fewer than its headers declare");
}

TEST(Ptx, MatricesByColumnsLeadWhereThoseByRowsDo) {
  const std::string turn = "0 -1 0 0\n1 0 0 0\n0 0 1 0\n0 0 0 1\n";  // without a shift
  const CloudFile file =
      read_text(scan(1, "1 2 3 0.5\n", turn) + scan(1, "1 2 3 0.5\n", kByColumns), "a.ptx");
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.format, "PTX, matrices by columns");
  EXPECT_LT((file.cloud.point(0) - Eigen::Vector3d(-2, 1, 3)).norm(), 1e-5);
  EXPECT_LT((file.cloud.point(1) - Eigen::Vector3d(8, 21, 33)).norm(), 1e-5);
  const CloudFile one = read_text(scan(1, "1 2 3 0.5\n", kByColumns), "a.ptx");
  EXPECT_EQ(*one.cloud.viewpoint, Eigen::Vector3d(10, 20, 30));
  EXPECT_THAT(refusal(scan(1, "1 2 3 4\n", kByColumns) + scan(1, "1 2 3 4\n")),
              HasSubstr("line 12: the matrix of the scan that begins here is written by rows"));
  EXPECT_THAT(refusal(scan(1, "1 2 3 4\n", "1 0 0 0\n0 1 0 0\n0 0 1 1\n0 0 1 2\n")),
              HasSubstr("is no motion"));
}

TEST(Ptx, SaysWhatIsWrong) {
  EXPECT_THAT(refusal(scan(2, "1 2 3 0.5\n"), "a.ptx"),
              HasSubstr("a.ptx, line 1: the file ends after 1 of the 2 points"));
  EXPECT_THAT(refusal("1\n2\n0 0 0\n", "a.ptx"), HasSubstr("ends within the header"));
  EXPECT_THAT(refusal("-1" + scan(1, "1 2 3 4\n").substr(1)), HasSubstr("a scan of -1 columns"));
  EXPECT_THAT(refusal(scan(3, "1 2 3 0.5\n1 2 3\n4 5 6 0.5\n")),
              HasSubstr("line 12: 3 values in a row, but the points of this scan have 4"));
  EXPECT_THAT(refusal(scan(1, "1 2 three 0.5\n")), HasSubstr("\"three\" is not a number"));
  EXPECT_THAT(refusal(scan(0, "")), HasSubstr("holds no points"));
}

}  // namespace
}  // namespace palpate
