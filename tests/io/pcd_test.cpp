#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats.hpp"
#include "io/reading.hpp"
#include "support/counts.hpp"

namespace palpate {
namespace {

using test::kCountOfHalfTheBits;
using test::kLargestCount;
using testing::HasSubstr;

struct Head {
  std::string fields = "x y z";
  std::string sizes = "4 4 4";
  std::string types = "F F F";
  std::string counts = "1 1 1";
  std::string width = "2";
  std::string height = "1";
  std::string viewpoint = "0 0 0 1 0 0 0";
  std::string points = "2";
  std::string data = "ascii";

  [[nodiscard]] std::string text() const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
           sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + width + "\nHEIGHT " +
           height + "\nVIEWPOINT " + viewpoint + "\nPOINTS " + points + "\nDATA " + data + "\n";
  }
};

Head rich(std::string data) {
  Head head;
  head.fields = "_ intensity x y z rgba normal_x normal_y normal_z label";
  head.sizes = "1 2 8 4 4 4 4 4 4 8";
  head.types = "U U F F F U F F F I";
  head.counts = "3 1 1 1 1 1 1 1 1 2";
  head.data = std::move(data);
  return head;
}

struct RichPoint {
  std::uint16_t intensity;
  double x;
  float y;
  float z;
  std::uint32_t rgba;
};
constexpr RichPoint kRichPoints[] = {{700, 0.5, 1, 2, 0xff0a141e}, {800, 0.75, 3, 4, 0x01020304}};

std::string rich_rows() {
  std::string rows;
  for (const RichPoint& p : kRichPoints) {
    rows += "abc";
    append(rows, p.intensity);
    append(rows, p.x);
    append(rows, p.y);
    append(rows, p.z);
    append(rows, p.rgba);
    for (const float n : {0.0F, 0.0F, 1.0F}) append(rows, n);
    for (const std::int64_t label : {1, 2}) append(rows, label);
  }
  return rows;
}

// The same, field by field, as literals of LZF.
std::string rich_compressed() {
  std::string columns;
  for (int i = 0; i < 2; ++i) columns += "abc";
  for (const RichPoint& p : kRichPoints) append(columns, p.intensity);
  for (const RichPoint& p : kRichPoints) append(columns, p.x);
  for (const RichPoint& p : kRichPoints) append(columns, p.y);
  for (const RichPoint& p : kRichPoints) append(columns, p.z);
  for (const RichPoint& p : kRichPoints) append(columns, p.rgba);
  for (const float n : {0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 1.0F}) append(columns, n);
  for (const std::int64_t label : {1, 2, 1, 2}) append(columns, label);
  std::string packed;
  for (std::size_t i = 0; i < columns.size(); i += 32) {
    const std::string run = columns.substr(i, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  std::string data;
  append(data, static_cast<std::uint32_t>(packed.size()));
  append(data, static_cast<std::uint32_t>(columns.size()));
  return data + packed;
}

void expect_rich_pcd(const CloudFile& file) {
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.cloud.positions[1], Eigen::Vector3f(0.75F, 3, 4));
  EXPECT_EQ(file.cloud.colors[0], (std::array<std::uint8_t, 3>{10, 20, 30}));
  EXPECT_EQ(file.cloud.colors[1], (std::array<std::uint8_t, 3>{2, 3, 4}));
  EXPECT_EQ(file.cloud.normals[1], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(file.cloud.intensities, (std::vector<float>{700, 800}));
}

TEST(Pcd, ReadsAsciiWithNan) {
  const CloudFile file = read_text(Head{}.text() + "1 2 3\nnan nan nan\n");
  EXPECT_EQ(file.format, "PCD, ascii");
  EXPECT_EQ(first_point(file), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(file.declared, 2u);
  EXPECT_EQ(file.dropped, 1u);
  EXPECT_EQ(file.cloud.width, 0u);
  EXPECT_FALSE(file.cloud.viewpoint);
}

TEST(Pcd, ReadsBinaryAndCompressedAlike) {
  expect_rich_pcd(read_text(rich("binary").text() + rich_rows()));
  expect_rich_pcd(read_text(rich("binary_compressed").text() + rich_compressed()));
}

TEST(Pcd, ReadsBinaryWithoutTheCommentThatBeginsIt) {
  const std::string text = rich("binary").text();
  expect_rich_pcd(read_text(text.substr(text.find('\n') + 1) + rich_rows()));
}

TEST(Pcd, ReadsPackedColoursInText) {
  Head head;
  head.fields += " rgb";
  head.sizes += " 4";
  head.counts += " 1";
  head.types = "F F F U";
  EXPECT_EQ(read_text(head.text() + "0 0 0 660510\n0 0 1 4278190335\n").cloud.colors[0],
            (std::array<std::uint8_t, 3>{10, 20, 30}));
  head.types = "F F F F";  // the float whose bits are 0x0a141e
  EXPECT_EQ(read_text(head.text() + "0 0 0 9.255716e-40\n0 0 1 nan\n").cloud.colors,
            (std::vector<std::array<std::uint8_t, 3>>{{10, 20, 30}, {0, 0, 0}}));
}

TEST(Pcd, KeepsTheViewpointWhenOrganisedOrSet) {
  Head head{.viewpoint = "1 2 3 1 0 0 0"};
  const std::string rows = "0 0 1\n0 1 1\n";
  EXPECT_EQ(read_text(head.text() + rows, "c", {.scale = 2}).cloud.viewpoint,
            Eigen::Vector3d(2, 4, 6));
  head.viewpoint = "0 0 0 0 1 0 0";  // what camera drivers write
  EXPECT_EQ(read_text(head.text() + rows).cloud.viewpoint, Eigen::Vector3d(0, 0, 0));
  head.viewpoint = "nan 0 0 1 0 0 0";
  EXPECT_FALSE(read_text(head.text() + rows).cloud.viewpoint);
  const CloudFile grid = read_text(Head{.width = "1", .height = "2"}.text() + rows);
  EXPECT_EQ(grid.cloud.viewpoint, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(grid.cloud.width, 1u);
  EXPECT_EQ(grid.cloud.height, 2u);
}

TEST(Pcd, KeepsThePixelsOfAnOrganisedCloudsPoints) {
  const std::string rows = "0 0 1\nnan nan nan\n0 1 1\n2 2 2\n";
  const Head grid{.width = "2", .height = "2", .points = "4"};
  const PointCloud cloud = read_text(grid.text() + rows).cloud;
  EXPECT_EQ(cloud.width, 2u);
  EXPECT_EQ(cloud.height, 2u);
  EXPECT_EQ(cloud.pixels, (std::vector<std::uint32_t>{0, 2, 3}));
  const Head loose{.width = "4", .height = "1", .points = "4"};
  EXPECT_TRUE(read_text(loose.text() + rows).cloud.pixels.empty());
}

TEST(Pcd, ReadsOldHeadersWithoutCountOrWidth) {
  EXPECT_EQ(read_text("COLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n")
                .cloud.size(),
            1u);
  EXPECT_EQ(read_text("VERSION .5\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n"
                      "DATA ascii\n1 2 3\n")
                .cloud.size(),
            1u);
}

TEST(Pcd, SaysHowManyPointsOfACutFileAreThere) {
  EXPECT_THAT(refusal(Head{}.text() + "1 2 3\n4 5"), HasSubstr("after 1 of 2 points"));
  std::string binary = Head{.data = "binary"}.text();
  for (int i = 0; i < 5; ++i) append<float>(binary, 1.0F);
  EXPECT_THAT(refusal(binary), HasSubstr("after 1 of 2 points"));
  EXPECT_THAT(refusal(binary), HasSubstr("WIDTH 1, HEIGHT 1 and POINTS 1"));
  const std::string packed = rich("binary_compressed").text() + rich_compressed();
  EXPECT_THAT(refusal(packed.substr(0, packed.size() - 1)), HasSubstr("compressed bytes declared"));
}

TEST(PcdRows, AreRefusedWhereTheyHaveAnotherNumberOfValuesThanDeclared) {
  const std::string begin = Head{.width = "3", .points = "3"}.text();
  EXPECT_THAT(refusal(begin + "0 0 0 9 9\n1 1 1 9 9\n2 2 2 9 9\n", "a.pcd"),
              HasSubstr("a.pcd, line 12: 5 values in a row, but the header declares 3"));
  EXPECT_THAT(refusal(begin + "0 0 0\n\n1 1\n2 2 2\n"),
              HasSubstr("line 14: 2 values in a row, but the header declares 3: \"1 1\""));
  EXPECT_THAT(refusal(begin + "0 0 0\n1 1\n1\n2 2 2\n"), HasSubstr("line 13: 2 values"));
  EXPECT_EQ(read_text(begin + "\n0 0 0 \r\n \n1 1 1\t\r\n2 2 2").cloud.size(), 3u);
}

TEST(PcdRows, BehindTheLastDeclaredOneAreTold) {
  const std::string_view told = ", 1 more than its header declares, which are not used";
  EXPECT_EQ(read_text(Head{}.text() + "0 0 0\n1 1 1\n2 2 2\n\n").format,
            "PCD, ascii" + std::string(told));
  std::string binary = Head{.data = "binary"}.text();
  for (int i = 0; i < 10; ++i) append<float>(binary, 1.0F);
  EXPECT_EQ(read_text(binary).format, "PCD, binary" + std::string(told));
}

TEST(Pcd, RefusesHostileCounts) {
  const Head most{.width = kLargestCount, .points = kLargestCount};
  EXPECT_THAT(refusal(most.text() + "1 2 3\n"), HasSubstr("after 1 of " + kLargestCount));
  const Head overflow{.width = kCountOfHalfTheBits, .height = kCountOfHalfTheBits, .points = "0"};
  EXPECT_THAT(refusal(overflow.text() + "1 2 3\n"), HasSubstr("is not POINTS"));
  Head wide;
  wide.counts = "1 1 99999999999";
  EXPECT_THAT(refusal(wide.text()), HasSubstr("an invalid COUNT"));
  Head bomb{.width = "300000000", .points = "300000000", .data = "binary_compressed"};
  std::string data = bomb.text();
  append<std::uint32_t>(data, 2);
  append<std::uint32_t>(data, 3600000000U);
  EXPECT_THAT(refusal(data + "ab"), HasSubstr("compressed bytes declared"));
}

TEST(Pcd, SaysWhatIsWrongInAHeader) {
  EXPECT_THAT(refusal(Head{.points = "3"}.text()), HasSubstr("is not POINTS 3"));
  EXPECT_THAT(refusal(Head{.types = "F F G"}.text()), HasSubstr("field \"z\" has type \"G\""));
  EXPECT_THAT(refusal(Head{.sizes = "4 4 3"}.text()), HasSubstr("of 3 bytes"));
  EXPECT_THAT(refusal(Head{.types = "F F"}.text()), HasSubstr("a different number"));
  EXPECT_THAT(refusal(Head{.fields = "x y w"}.text()), HasSubstr("lack x, y or z"));
  EXPECT_THAT(refusal(Head{.viewpoint = "0 0 0"}.text()), HasSubstr("line 9: VIEWPOINT"));
  EXPECT_THAT(refusal(Head{.data = "zip"}.text()), HasSubstr("line 11: DATA"));
  EXPECT_THAT(refusal(Head{.width = "two"}.text()), HasSubstr("line 7"));
  EXPECT_THAT(refusal("# .PCD v0.7\nVERSION 0.7\n"), HasSubstr("no DATA line"));
  EXPECT_THAT(refusal("# .PCD v0.7\nHELLO\n"), HasSubstr("unknown word \"HELLO\""));
}

}  // namespace
}  // namespace palpate
