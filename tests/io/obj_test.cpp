#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats.hpp"
#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

TEST(Obj, ReadsVerticesAndSkipsTheRest) {
  const CloudFile file =
      read_text("# made by hand\nmtllib a.mtl\no thing\nv 1 2 3\nvt 0 0\nv\t4 5 6 1.0\nf 1 2 1\n");
  EXPECT_EQ(file.format, "OBJ");
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.cloud.positions[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_TRUE(file.cloud.normals.empty());
}

TEST(Obj, KeepsNormalsWhenThereAreAsManyAsVertices) {
  EXPECT_EQ(read_text("v 1 2 3\nvn 0 0 2\nvn 0 3 0\nv 4 5 6\n").cloud.normals[1],
            Eigen::Vector3f(0, 1, 0));
  EXPECT_TRUE(read_text("v 1 2 3\nvn 0 0 2\nv 4 5 6\n").cloud.normals.empty());
}

TEST(Obj, ReadsColoursBehindTheCoordinates) {
  EXPECT_EQ(read_text("v 1 2 3 0 0.2 1\nv 1 2 3 0 0 0\n").cloud.colors[0],
            (std::array<std::uint8_t, 3>{0, 51, 255}));
}

TEST(Obj, LinesGoOnAfterABackslash) {
  const std::string text =
      "v 0 0 \\\n0\nv 1 0 0 # a comment\nv 1 1 0\nv 0 1 0\nf 1 2 \\\r\n 3\nfo 1 3 4\n";
  const CloudFile file = read_text(text, "a.obj");
  ASSERT_TRUE(file.mesh);
  EXPECT_EQ(file.mesh->triangles, 2u);
  EXPECT_THAT(refusal(text + "f 1 2 9\n", "a.obj"), HasSubstr("line 9: a face has vertex \"9\""));
}

TEST(Obj, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(refusal("v 1 2 3\nv 1 two 3\n"), HasSubstr("line 2: \"two\" is not a number"));
  EXPECT_THAT(refusal("v 1 2\n"), HasSubstr("line 1: 2 numbers"));
  EXPECT_THAT(refusal("o thing\nf 1 2 3\n"), HasSubstr("no vertices"));
  EXPECT_THAT(refusal("hello\n", "a.obj"), HasSubstr("no vertices"));
}

}  // namespace
}  // namespace palpate
