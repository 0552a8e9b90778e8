// Scenes of glTF that have points instead of faces.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/reading.hpp"
#include "support/mesh_files.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

const test::TestMesh kCorners{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
constexpr const char* kPart = R"({"attributes":{"POSITION":0},"indices":1})";

// The corners as GLB, with `parts` as the primitives of its mesh.
std::string glb_of(const std::string& parts) {
  std::string json = test::gltf_json(kCorners);
  const std::size_t at = json.find(kPart);
  EXPECT_NE(at, std::string::npos);
  return test::glb(json.replace(at, std::string(kPart).size(), parts), test::gltf_data(kCorners));
}

TEST(GltfPoints, AreACloud) {
  const CloudFile file = read_text(glb_of(R"({"attributes":{"POSITION":0},"mode":0})"), "a.glb");
  EXPECT_EQ(file.format, "glTF, binary");
  EXPECT_FALSE(file.mesh);
  ASSERT_EQ(file.cloud.size(), 4U);
  EXPECT_TRUE(file.cloud.point(2).isApprox(Vector3d(2, 1, 0), 1e-6)) << file.cloud.point(2);
  EXPECT_TRUE(file.cloud.colors.empty());
}

TEST(GltfPoints, AreThoseThatIndicesName) {
  const std::string part = R"({"attributes":{"POSITION":0},"indices":1,"mode":0})";
  EXPECT_EQ(read_text(glb_of(part), "a.glb").cloud.size(), 3U);
  EXPECT_EQ(read_text(glb_of(part + "," + part), "a.glb").cloud.size(), 6U);
}

TEST(GltfPoints, BesideFacesAreNotFelt) {
  const std::string points = R"({"attributes":{"POSITION":0},"mode":0})";
  const CloudFile file = read_text(glb_of(fmt::format("{},{}", points, kPart)), "a.glb");
  ASSERT_TRUE(file.mesh);
  EXPECT_EQ(file.mesh->triangles, 1U);
}

TEST(GltfPoints, LinesAreNone) {
  EXPECT_THAT(refusal(glb_of(R"({"attributes":{"POSITION":0},"mode":1})"), "a.glb"),
              HasSubstr("neither triangles nor points"));
}

TEST(GltfVersion, OneIsNamedOfABinaryFile) {
  std::string bytes = test::as_glb(kCorners);
  overwrite<std::uint32_t>(bytes, 4, 1);
  EXPECT_THAT(refusal(bytes, "a.glb"), HasSubstr("binary glTF of version 1. Export it again"));
}

}  // namespace
}  // namespace palpate
