#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/input.hpp"
#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

io::FileKind kind(std::string_view bytes, const std::string& name = "file") {
  const ReadOptions options;
  return io::kind_of({std::as_bytes(std::span(bytes)), name, options});
}

TEST(FileKind, GoesByTheBytesBeforeTheName) {
  EXPECT_EQ(kind("ply\nformat", "a.pcd"), io::FileKind::ply);
  EXPECT_EQ(kind("LASF", "a.txt"), io::FileKind::las);
  EXPECT_EQ(kind("ASTM-E57", "a.las"), io::FileKind::e57);
  EXPECT_EQ(kind("# .PCD v0.7\n", "a.xyz"), io::FileKind::pcd);
  EXPECT_EQ(kind("# a comment\nVERSION 0.7\n"), io::FileKind::pcd);
  EXPECT_EQ(kind("v 1 2 3\n", "a.txt"), io::FileKind::obj);
  EXPECT_EQ(kind("1 2 3\n", "a.obj"), io::FileKind::obj);
  EXPECT_EQ(kind("1 2 3\n", "a.ply"), io::FileKind::xyz);
  EXPECT_EQ(kind("solid cube\n", "a.txt"), io::FileKind::stl);
  EXPECT_EQ(kind("1 2 3\n", "A.STL"), io::FileKind::stl);
  EXPECT_EQ(kind("glTF", "a.txt"), io::FileKind::gltf);
  EXPECT_EQ(kind("{\"asset\": 1}"), io::FileKind::gltf);
  EXPECT_EQ(kind(" {}", "a.gltf"), io::FileKind::gltf);
}

TEST(FileKind, AByteOrderMarkMeansNothing) {
  const std::string mark = "\xEF\xBB\xBF";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n";
  const std::string pcd =
      "# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n";
  for (const std::string& text : {ply, pcd, std::string("1 2 3\n"), std::string("v 1 2 3\n")}) {
    EXPECT_EQ(read_text(mark + text).format, read_text(text).format);
  }
  EXPECT_EQ(refusal(mark + "{\"asset\": 1}"), refusal("{\"asset\": 1}"));
  EXPECT_EQ(refusal(mark + "[1]"), refusal("[1]"));
}

TEST(FileKind, SaysWhatToDoAboutKindsThatAreNotRead) {
  using namespace std::string_view_literals;
  EXPECT_THAT(refusal("\xfd"
                      "7zXZ\0data"sv),
              HasSubstr("xz -dk"));
  EXPECT_THAT(refusal("(\xb5/\xfd"), HasSubstr("zstd -d"));
  EXPECT_THAT(refusal("\x89MCAP0"), HasSubstr("palpate touch bag:"));
  EXPECT_THAT(refusal("\x89MCAP0"), HasSubstr("palpate replay "));
  EXPECT_THAT(refusal("PK\x03\x04zip"), HasSubstr("ZIP archive"));
  EXPECT_THAT(refusal("\xff\xd8\xff\xe0 JFIF"), HasSubstr("a JPEG picture"));
  EXPECT_THAT(refusal("\xff\xfe\x30\0"sv), HasSubstr("UTF-16 text"));
  EXPECT_THAT(refusal("\xfe\xff\0\x30"sv), HasSubstr("as UTF-8"));
  EXPECT_THAT(refusal("{\"width\": 640}"), HasSubstr("JSON"));
  EXPECT_THAT(refusal("[hand]\nseed = 3\n", "a.toml"), HasSubstr("palpate touch --setup a.toml"));
  EXPECT_THAT(refusal("<!DOCTYPE html>"), HasSubstr("web page"));
  EXPECT_THAT(refusal("version https://git-lfs.github.com/spec/v1\n"), HasSubstr("git lfs pull"));
}

TEST(FileKind, SaysWhatArchivesAndDocumentsAre) {
  using namespace std::string_view_literals;
  const auto zip = [](const std::string& member) {
    return "PK\x03\x04" + std::string(26, 'x') + member;
  };
  EXPECT_THAT(refusal(zip("scan.usdc"), "room.zip"), HasSubstr("USDZ"));
  EXPECT_THAT(refusal("PK\x03\x04", "room.USDZ"), HasSubstr("as GLB, OBJ or PLY"));
  EXPECT_THAT(refusal(zip("3D/3dmodel.model")), HasSubstr("3MF"));
  EXPECT_THAT(refusal(zip("points.npy")), HasSubstr("np.load('IN.npz')"));
  EXPECT_THAT(refusal(zip("a.ply")), HasSubstr("unzip"));
  EXPECT_THAT(refusal("<?xml version=\"1.0\"?>\n<COLLADA>"), HasSubstr("COLLADA"));
  EXPECT_THAT(refusal("<VTKFile type=\"PolyData\">", "a.vtp"), HasSubstr("VTK"));
  EXPECT_THAT(refusal("{\"hierarchyType\": \"json\"}", "ept.json"), HasSubstr("Entwine"));
  EXPECT_THAT(refusal("{\"version\": \"1.7\", \"octreeDir\": \"data\"}"), HasSubstr("Potree 1"));
  EXPECT_THAT(refusal("{\"asset\": {\"version\": \"1.0\"}, \"geometricError\": 1}"),
              HasSubstr("3D Tiles"));
  EXPECT_THAT(refusal("\x01\0\0\0\0\0\0\0"sv, "sparse/0/points3D.bin"), HasSubstr("COLMAP"));
  EXPECT_THAT(refusal("PXR-USDC"), HasSubstr("USD"));
}

TEST(FileKind, ShowsTheFirstBytesOfWhatItDoesNotKnow) {
  EXPECT_THAT(refusal(std::string("\x01\x02\x00\xff", 4), "a.dat"),
              HasSubstr("a.dat: unknown file type (it starts with 01 02 00 ff)"));
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
}

}  // namespace
}  // namespace palpate
