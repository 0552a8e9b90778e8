#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats.hpp"
#include "io/reading.hpp"
#include "support/counts.hpp"

namespace palpate {
namespace {

using test::kLargestCount;
using testing::HasSubstr;

constexpr std::string_view kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(std::string_view format, std::size_t count, std::string_view properties) {
  return "ply\nformat " + std::string(format) + " 1.0\nelement vertex " + std::to_string(count) +
         "\n" + std::string(properties) + "end_header\n";
}

std::string rich_rows(std::endian order) {
  std::string rows;
  for (const double x : {0.125, 637291.5}) {
    append<std::uint8_t>(rows, 10, order);  // blue
    append<double>(rows, x, order);
    append<std::uint8_t>(rows, 2, order);  // a list of two
    append<std::int16_t>(rows, 7, order);
    append<std::int16_t>(rows, 8, order);
    append<std::int32_t>(rows, 851210, order);  // y
    append<float>(rows, 1.5F, order);           // z
    append<float>(rows, 3.0F, order);           // nx ny nz
    append<float>(rows, 0.0F, order);
    append<float>(rows, 4.0F, order);
    append<std::uint8_t>(rows, 200, order);  // red
    append<std::uint8_t>(rows, 100, order);  // green
    append<std::uint16_t>(rows, 513, order);
  }
  return rows;
}

constexpr std::string_view kRich =
    "property uchar blue\nproperty double x\nproperty list uchar short more\nproperty int32 y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property uint8 red\nproperty uchar green\nproperty ushort quality\n";

void expect_rich_ply(const CloudFile& file) {
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_NEAR(file.cloud.point(0).x(), 0.125, 0.05);
  EXPECT_NEAR(file.cloud.point(1).x(), 637291.5, 0.05);
  EXPECT_NEAR(file.cloud.point(1).y(), 851210, 0.05);
  EXPECT_EQ(file.cloud.normals[0], Eigen::Vector3f(0.6F, 0, 0.8F));
  EXPECT_EQ(file.cloud.colors[1], (std::array<std::uint8_t, 3>{200, 100, 10}));
  EXPECT_EQ(file.cloud.intensities[0], 513);
}

TEST(Ply, ReadsAsciiAndSkipsOtherElements) {
  const CloudFile file = read_text(
      "ply\nformat ascii 1.0\ncomment hello\nobj_info num_cols 512\n"
      "element edge 2\nproperty list uchar int ends\nproperty float weight\n"
      "element vertex 2\n" +
      std::string(kXyz) +
      "property float confidence\n"
      "property float intensity\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n2 0 1 0.5\n0 9\n0.1 0.2 0.3 1 0.7\n-1e-2 +2 3 1 0.8\n3 0 1 0\n");
  EXPECT_EQ(file.format, "PLY, ascii");
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.cloud.positions[0], Eigen::Vector3f(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(file.cloud.positions[1], Eigen::Vector3f(-0.01F, 2, 3));
  EXPECT_EQ(file.cloud.intensities[1], 0.8F);
  EXPECT_EQ(file.cloud.origin, Eigen::Vector3d::Zero());
}

// The file's order of elements says nothing of what they mean.
TEST(Ply, FacesMayComeBeforeTheirVertices) {
  const std::string faces =
      "element face 1\nproperty uchar flags\nproperty list uchar int more\n"
      "property list uchar int vertex_indices\n";
  const std::string vertices = "element vertex 3\n" + std::string(kXyz);
  const std::string begin = "ply\nformat ascii 1.0\n";
  const std::string face_row = "7 2 5 6 3 0 1 2\n";
  const std::string vertex_rows = "0 0 0\n1 0 0\n0 1 0\n";
  const CloudFile first =
      read_text(begin + faces + vertices + "end_header\n" + face_row + vertex_rows);
  const CloudFile last =
      read_text(begin + vertices + faces + "end_header\n" + vertex_rows + face_row);
  ASSERT_TRUE(first.mesh);
  EXPECT_EQ(first.mesh->triangles, 1u);
  EXPECT_EQ(first.mesh->dropped, 0u);
  EXPECT_EQ(first.cloud.positions, last.cloud.positions);
  EXPECT_THAT(refusal(begin + faces + vertices + "end_header\n7 2 5 6 3 0 1 3\n" + vertex_rows),
              HasSubstr("a face has vertex 3, but there are 3"));
}

// Such an element is points; rows behind it are not read.
TEST(Ply, AnElementOfFacesThatHasPlacesIsPoints) {
  const CloudFile file = read_text(
      "ply\nformat ascii 1.0\nelement face 1\n" + std::string(kXyz) +
      "property list uchar int vertex_indices\nelement more 9\nproperty float a\nend_header\n"
      "1 2 3 1 0\n");
  EXPECT_EQ(file.cloud.size(), 1u);
  EXPECT_FALSE(file.mesh);
}

TEST(Ply, TellsHowFarItIsInElementsThatItSkips) {
  std::string text =
      "ply\nformat ascii 1.0\nelement more 900\nproperty float a\n"
      "element vertex 1\n" +
      std::string(kXyz) + "end_header\n";
  for (int i = 0; i < 900; ++i) text += "1\n";
  int calls = 0;
  (void)read_text(text + "1 2 3\n", "a.ply", {.progress = [&](double) { ++calls; }});
  EXPECT_GT(calls, 50);
}

TEST(Ply, ReadsBothByteOrdersWithPropertiesInAnyOrder) {
  expect_rich_ply(
      read_text(header("binary_little_endian", 2, kRich) + rich_rows(std::endian::little)));
  expect_rich_ply(read_text(header("binary_big_endian", 2, kRich) + rich_rows(std::endian::big)));
}

TEST(Ply, ReadsWindowsAndOldMacintoshLineEnds) {
  const std::string body = header("ascii", 1, kXyz) + "1 2 3\n";
  for (const std::string_view end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : body) c == '\n' ? text += end : text += c;
    EXPECT_EQ(first_point(read_text(text)), Eigen::Vector3f(1, 2, 3));
  }
}

TEST(Ply, BringsColoursOfEveryScaleToBytes) {
  const auto color = [](std::string_view type, std::string_view row) {
    std::string properties{kXyz};
    for (const std::string_view name : {"red", "green", "blue"}) {
      properties += "property " + std::string(type) + " " + std::string(name) + "\n";
    }
    return read_text(header("ascii", 1, properties) + "0 0 0 " + std::string(row)).cloud.colors[0];
  };
  using Color = std::array<std::uint8_t, 3>;
  EXPECT_EQ(color("uchar", "0 1 255\n"), (Color{0, 1, 255}));
  EXPECT_EQ(color("float", "0 0.5 1\n"), (Color{0, 128, 255}));
  EXPECT_EQ(color("float", "0 1 255\n"), (Color{0, 1, 255}));
  EXPECT_EQ(color("ushort", "0 257 65535\n"), (Color{0, 1, 255}));
  EXPECT_EQ(color("float", "nan -1 1e300\n"), (Color{0, 0, 0}));
}

TEST(Ply, DropsAndCountsPointsThatAreNotFinite) {
  const CloudFile file =
      read_text(header("ascii", 4, kXyz) + "nan 0 0\n0 inf 0\n1 2 3\n1e400 0 0\n");
  EXPECT_EQ(file.cloud.size(), 1u);
  EXPECT_EQ(file.declared, 4u);
  EXPECT_EQ(file.dropped, 3u);
  EXPECT_THAT(refusal(header("ascii", 1, kXyz) + "nan 0 0\n"), HasSubstr("none of the 1 points"));
}

TEST(Ply, SaysWhereAFileIsCutAndHowManyPointsAreThere) {
  const std::string ascii = header("ascii", 3, kXyz) + "0 0 0\n1 1 1\n2 2";
  EXPECT_THAT(refusal(ascii, "a.ply"), HasSubstr("a.ply, byte"));
  EXPECT_THAT(refusal(ascii), HasSubstr("ends after 2 of 3 rows"));
  EXPECT_THAT(refusal(ascii), HasSubstr("\"element vertex 2\""));
  std::string binary = header("binary_little_endian", 1000, kXyz);
  for (int i = 0; i < 7; ++i) append<float>(binary, 1.0F);
  EXPECT_THAT(refusal(binary), HasSubstr("ends after 2 of 1000 rows"));
}

TEST(Ply, RefusesCountsThatTheBytesCannotHoldWithoutAskingForMemory) {
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex " + kLargestCount + "\n" +
                      std::string(kXyz) + "end_header\n1 2 3\n"),
              HasSubstr("ends after 1 of " + kLargestCount));
  EXPECT_THAT(refusal("ply\nformat binary_little_endian 1.0\nelement empty " + kLargestCount +
                      "\nelement vertex 1\n" + std::string(kXyz) + "end_header\n"),
              HasSubstr("ends after 0 of 1 rows"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement face 1\nproperty list int int v\n"
                      "element vertex 1\n" +
                      std::string(kXyz) + "end_header\n-3 1 2 3\n"),
              HasSubstr("invalid list length -3"));
}

TEST(Ply, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(refusal(header("ascii", 2, kXyz) + "0 0 0\n1 zwei 1\n"),
              testing::AllOf(HasSubstr("line 9"), HasSubstr("\"zwei\" is not a number")));
  EXPECT_THAT(refusal("ply\nformat utf8 1.0\n"), HasSubstr("line 2: unknown PLY format \"utf8\""));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex -3\n"), HasSubstr("line 3"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nproperty float x\n"),
              HasSubstr("before any element"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n"),
              HasSubstr("unknown type \"half\""));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\n"),
              HasSubstr("not an integer"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\n"), HasSubstr("no end_header"));
  EXPECT_THAT(refusal("ply\nelement vertex 1\nend_header\n"), HasSubstr("no format line"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nhello\n"), HasSubstr("unknown word \"hello\""));
  EXPECT_THAT(refusal(header("ascii", 1, "property float x\nproperty float y\n") + "1 2\n"),
              HasSubstr("x, y and z"));
  EXPECT_THAT(refusal(header("ascii", 0, kXyz)), HasSubstr("holds no points"));
}

// Values too many or too few must not become those of the next rows.
TEST(PlyRows, AreRefusedWhereTheyHaveAnotherNumberOfValuesThanDeclared) {
  const std::string begin = header("ascii", 3, kXyz);
  EXPECT_THAT(
      refusal(begin + "0 0 0 9\n1 1 1 9\n2 2 2 9\n", "a.ply"),
      HasSubstr("a.ply, line 8: 4 values in a row, but the header declares 3: \"0 0 0 9\""));
  EXPECT_THAT(refusal(begin + "0 0 0\n\n1 1\n2 2 2\n"),
              HasSubstr("line 10: 2 values in a row, but the header declares 3"));
  // What is consumed ends with a line here, but a line is left.
  EXPECT_THAT(refusal(header("ascii", 4, kXyz) + "0 0 0 9\n1 1 1 9\n2 2 2 9\n3 3 3 9\n"),
              HasSubstr("line 8: 4 values in a row"));
  const std::string faces =
      "ply\nformat ascii 1.0\nelement vertex 3\n" + std::string(kXyz) +
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(refusal(faces + "3 0 1 2 1\n3 2 1 0\n"),
              HasSubstr("line 13: 5 values in a row, but the header declares 4"));
}

TEST(PlyRows, MayBeBrokenOverLinesAndShareThem) {
  for (const std::string_view rows :
       {"0 0\n0\n1\n1 1\n2 2 2\n", "0 0 0 1 1\n1 2 2 2\n", "0 0 0 1 1 1 2 2 2"}) {
    const CloudFile file = read_text(header("ascii", 3, kXyz) + std::string(rows));
    ASSERT_EQ(file.cloud.size(), 3u);
    EXPECT_EQ(file.cloud.point(1), Eigen::Vector3d(1, 1, 1));
    EXPECT_EQ(file.cloud.point(2), Eigen::Vector3d(2, 2, 2));
  }
}

TEST(PlyRows, BehindTheLastDeclaredOneAreTold) {
  const std::string_view told = ", 2 more than its header declares, which are not used";
  const std::string text = header("ascii", 1, kXyz) + "0 0 0\n1 1 1\n\n2 2 2\n";
  EXPECT_EQ(read_text(text).format, "PLY, ascii" + std::string(told));
  std::string binary = header("binary_little_endian", 1, kXyz);
  for (int i = 0; i < 9; ++i) append<float>(binary, 1.0F);
  EXPECT_EQ(read_text(binary).format, "PLY, binary little endian" + std::string(told));
}

// A square of two triangles, the second of which goes round the other way in the strip.
TEST(PlyStrips, AreTheirTriangles) {
  const auto mesh = [](std::string_view name, std::string_view type, std::string_view rows) {
    return read_text("ply\nformat ascii 1.0\nelement vertex 5\n" + std::string(kXyz) + "element " +
                     std::string(name) + "\nproperty list int " + std::string(type) +
                     " vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 5 5\n" +
                     std::string(rows));
  };
  const CloudFile strips = mesh("tristrips 1", "int", "11 0 1 2 3 3 -1 1 2 -1 4 -1\n");
  const CloudFile faces = mesh("face 2", "int", "3 0 1 2\n3 2 1 3\n");
  ASSERT_TRUE(strips.mesh);
  EXPECT_EQ(strips.mesh->triangles, 2u);
  EXPECT_EQ(strips.mesh->dropped, 0u);
  EXPECT_EQ(strips.cloud.positions, faces.cloud.positions);
  EXPECT_EQ(strips.cloud.normals, faces.cloud.normals);
}

TEST(Ply, ManyColumnsAreRefused) {
  std::string text = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 5000; ++i) text += "element e" + std::to_string(i) + " 0\n";
  EXPECT_THAT(refusal(text), HasSubstr("more than 4096"));
}

}  // namespace
}  // namespace palpate
