// Scenes of glTF and GLB: placed, of every kind of index, from each place that data may lie in, and
// refused with words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/reading.hpp"
#include "support/folder.hpp"
#include "support/mesh_files.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

// Two triangles in the plane z = 0 of palpate, 2 m wide and 1 m long.
const test::TestMesh kSheet{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The sheet as GLB, with `to` in the place of `from` in its JSON.
std::string changed(const std::string& from, const std::string& to) {
  return test::glb(replaced(test::gltf_json(kSheet), from, to), test::gltf_data(kSheet));
}

CloudFile read_node(const std::string& node) {
  return read_text(test::glb(test::gltf_json(kSheet, "", node), test::gltf_data(kSheet)), "a.glb");
}

Box bounds(const CloudFile& file) {
  Box box;
  for (std::size_t i = 0; i < file.cloud.size(); ++i) box.extend(file.cloud.point(i));
  return box;
}

void expect_box(const CloudFile& file, const Vector3d& lower, const Vector3d& upper) {
  const Box box = bounds(file);
  EXPECT_TRUE(box.lower.isApprox(lower, 0.01) || (box.lower - lower).norm() < 0.01)
      << box.lower.transpose();
  EXPECT_TRUE((box.upper - upper).norm() < 0.01 * upper.norm() + 0.01) << box.upper.transpose();
}

TEST(Gltf, AreMetresWithYUp) {
  const CloudFile file = read_text(test::as_glb(kSheet));
  EXPECT_EQ(file.format, "glTF, binary");
  ASSERT_TRUE(file.mesh);
  EXPECT_EQ(file.mesh->triangles, 2u);
  expect_box(file, {0, 0, 0}, {2, 1, 0});
  EXPECT_EQ(file.cloud.normals.front(), Eigen::Vector3f::UnitZ());
  expect_box(read_text(test::as_glb(kSheet), "a", {.scale = 0.5}), {0, 0, 0}, {1, 0.5, 0});
}

TEST(Gltf, NodesPlaceTheirMeshes) {
  expect_box(read_node(R"(,"translation":[0,5,0])"), {0, 0, 5}, {2, 1, 5});
  expect_box(read_node(R"(,"scale":[3,1,1])"), {0, 0, 0}, {6, 1, 0});
  // A quarter turn about y of the file, which is z here.
  expect_box(read_node(R"(,"rotation":[0,0.70710678,0,0.70710678])"), {-1, 0, 0}, {0, 2, 0});
  expect_box(read_node(R"(,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 7,8,9,1])"), {7, -9, 8},
             {9, -8, 8});
  const CloudFile mirrored = read_node(R"(,"scale":[-1,1,1])");
  EXPECT_EQ(mirrored.cloud.normals.front(), Eigen::Vector3f::UnitZ());  // still outside
  const std::string nested = changed(
      R"("nodes":[{"mesh":0}])",
      R"("nodes":[{"children":[1],"translation":[1,0,0]},{"mesh":0,"translation":[0,0,-2]}])");
  expect_box(read_text(nested), {1, 2, 0}, {3, 3, 0});
}

TEST(Gltf, TakesStripsFansAndListsWithIndicesOfEveryKind) {
  const std::string positions = test::gltf_data(kSheet).substr(0, 48);
  const auto file = [&](const std::string& mode, int component, const std::string& indices) {
    const std::size_t size = component == 5121 ? 1 : component == 5123 ? 2 : 4;
    std::string json = test::gltf_json(kSheet);
    json = replaced(json, "5125,\"count\":6",
                    fmt::format("{},\"count\":{}", component, indices.size() / size));
    json = replaced(json, "\"indices\":1", "\"indices\":1,\"mode\":" + mode);
    return test::glb(json, positions + indices + std::string(24, '\0'));
  };
  const auto as = [](auto type, std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) test::put(bytes, static_cast<decltype(type)>(value));
    return bytes;
  };
  for (const std::string& bytes : {file("4", 5121, as(std::uint8_t{}, {0, 1, 2, 0, 2, 3})),
                                   file("4", 5123, as(std::uint16_t{}, {0, 1, 2, 0, 2, 3})),
                                   file("5", 5121, as(std::uint8_t{}, {1, 2, 0, 3})),
                                   file("6", 5125, as(std::uint32_t{}, {0, 1, 2, 3}))}) {
    const CloudFile read = read_text(bytes);
    EXPECT_EQ(read.mesh->triangles, 2u);
    expect_box(read, {0, 0, 0}, {2, 1, 0});
    for (const auto& n : read.cloud.normals) ASSERT_EQ(n, Eigen::Vector3f::UnitZ());
  }
  EXPECT_THAT(refusal(file("4", 5121, as(std::uint8_t{}, {0, 1, 9, 0, 2, 3}))),
              HasSubstr("an index is 9, but there are 4 vertices"));
  EXPECT_THAT(refusal(file("1", 5121, as(std::uint8_t{}, {0, 1}))),
              HasSubstr("has neither triangles"));
}

TEST(Gltf, TakesColoursOfMaterials) {
  const std::string material = changed(
      "\"indices\":1", R"("indices":1,"material":0}]}],"materials":[{"pbrMetallicRoughness":{)"
                       R"("baseColorFactor":[1,0.2158605,0,1]}}],"more":[{"primitives":[{"a":0)");
  const CloudFile file = read_text(material);
  ASSERT_EQ(file.cloud.colors.size(), file.cloud.size());
  EXPECT_EQ(file.cloud.colors[0], (std::array<std::uint8_t, 3>{255, 128, 0}));  // as sRGB
  EXPECT_TRUE(read_text(test::as_glb(kSheet)).cloud.colors.empty());
}

// gltf_data() of the sheet, in base64.
std::string base64(const std::string& bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
    unsigned three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8U | static_cast<std::uint8_t>(bytes[i + k]);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += kLetters[three >> shift & 63U];
  }
  return text;
}

std::string refused(const std::filesystem::path& path) {
  try {
    (void)read_cloud(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Gltf, FindsDataInItselfAndBesideIt) {
  const std::string data = test::gltf_data(kSheet);
  ASSERT_EQ(data.size() % 3, 0u);
  const std::string inside = test::gltf_json(
      kSheet, R"(,"uri":"data:application/octet-stream;base64,)" + base64(data) + "\"");
  const CloudFile embedded = read_text(inside, "a.gltf");
  EXPECT_EQ(embedded.format, "glTF");
  expect_box(embedded, {0, 0, 0}, {2, 1, 0});
  const std::string beside = test::gltf_json(kSheet, R"(,"uri":"the%20data.bin")");
  EXPECT_THAT(refusal(beside, "a.gltf"), HasSubstr("\"the data.bin\""));
  const test::Folder folder;
  folder.write("a.gltf", beside);
  EXPECT_THAT(refused(folder / "a.gltf"), HasSubstr("\"the data.bin\", which is not beside it"));
  folder.write("the data.bin", data);
  EXPECT_EQ(read_cloud(folder / "a.gltf").size(), embedded.cloud.size());
  for (const char* uri : {"../x.bin", "/etc/passwd", "a/../../x.bin"}) {
    folder.write("b.gltf", test::gltf_json(kSheet, fmt::format(",\"uri\":\"{}\"", uri)));
    EXPECT_THAT(refused(folder / "b.gltf"), HasSubstr("outside its folder")) << uri;
  }
}

TEST(Gltf, SaysWhatItDoesNotTake) {
  EXPECT_THAT(
      refusal(changed("\"scene\":0", R"("extensionsRequired":["KHR_draco_mesh_compression"])")),
      HasSubstr("\"KHR_draco_mesh_compression\" of glTF is not supported. Export it without"));
  EXPECT_THAT(refusal(changed("\"bufferView\":0,", "")),
              HasSubstr("accessor 0 is sparse, compressed"));
  EXPECT_THAT(refusal(changed("\"bufferView\":0,", "\"sparse\":{},\"bufferView\":0,")),
              HasSubstr("accessor 0 is sparse"));
  EXPECT_THAT(refusal(changed("\"2.0\"", "\"1.0\"")), HasSubstr("not glTF 2"));
  EXPECT_THAT(refusal("{\"asset\":", "a.gltf"), HasSubstr("its JSON is broken"));
  EXPECT_THAT(refusal(changed("\"mesh\":0", "\"children\":[0]")), HasSubstr("has two parents"));
  EXPECT_THAT(refusal(changed("\"count\":4", "\"count\":4000000000")),
              HasSubstr("but bytes for 4"));
  EXPECT_THAT(refusal(changed("\"count\":4", "\"count\":-4")), HasSubstr("\"count\" is -4"));
  EXPECT_THAT(refusal(changed("\"mesh\":0", "\"mesh\":3")), HasSubstr("number 3 is asked for"));
  EXPECT_THAT(refusal(changed("\"byteLength\":48}", "\"byteLength\":480}")),
              HasSubstr("bufferView 0"));
  const std::string whole = test::as_glb(kSheet);
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 8)), HasSubstr("ends inside a part of GLB"));
}

TEST(Gltf, NamesAWrongValueHoweverDeepItIs) {
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  EXPECT_THAT(refusal(changed("\"scene\":0", "\"scene\":" + deep)),
              HasSubstr("\"scene\" is array, not a count"));
}

// A file may name itself any number of times.
TEST(Gltf, AFileThatManyBuffersNameIsReadOnce) {
  constexpr int kBuffers = 3000;
  std::string buffers = "\"buffers\":[";
  std::string views = "\"bufferViews\":[";
  std::string accessors = "\"accessors\":[";
  std::string primitives = "\"meshes\":[{\"primitives\":[";
  for (int i = 0; i < kBuffers; ++i) {
    const char* comma = i == 0 ? "" : ",";
    std::string uri;
    for (int k = 0; k < i % 50; ++k) uri += "./";
    buffers += fmt::format("{}{{\"uri\":\"{}%61.gltf\"}}", comma, uri);
    views += fmt::format("{}{{\"buffer\":{},\"byteLength\":36}}", comma, i);
    accessors += fmt::format(
        "{}{{\"bufferView\":{},\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}}", comma, i);
    primitives += fmt::format("{}{{\"attributes\":{{\"POSITION\":{}}}}}", comma, i);
  }
  const test::Folder folder;
  folder.write("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}]," + buffers +
                             "]," + views + "]," + accessors + "]," + primitives +
                             "]}],\"pad\":\"" + std::string(4'000'000, 'x') + "\"}");
  EXPECT_THAT(refused(folder / "a.gltf"), HasSubstr("none of the 3000 faces"));  // they are text
}

TEST(Gltf, MeshesOfManyPartsThatManyNodesShareAreRefused) {
  std::string nodes = "\"nodes\":[{\"mesh\":0}";
  std::string parts = "\"primitives\":[{\"mode\":0}";
  for (int i = 0; i < 3000; ++i) {
    nodes += ",{\"mesh\":0}";
    parts += ",{\"mode\":0}";
  }
  const std::string scene =
      "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{" + parts + "]}]," + nodes + "]}";
  EXPECT_THAT(refusal(scene, "a.gltf"), HasSubstr("more than 3 million parts of meshes"));
}

// Parts of a mesh often share their vertices and have indices of their own.
TEST(Gltf, PartsThatShareVerticesTakeThoseThatTheyName) {
  const std::string part = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
  const std::string whole = test::gltf_json(kSheet);
  ASSERT_NE(whole.find(part), std::string::npos) << whole;
  const CloudFile file = read_text(changed(part, part + "," + part));
  EXPECT_EQ(file.declared, 8u);
  EXPECT_EQ(file.mesh->duplicates, 2u);
  expect_box(file, {0, 0, 0}, {2, 1, 0});
}

// Two nodes that both have the next two would be 2^30 instances.
TEST(Gltf, NodesHaveOneParent) {
  std::string nodes = "\"nodes\":[{\"children\":[1,2]}";
  for (int i = 1; i <= 60; ++i) {
    const int next = 2 * ((i + 1) / 2) + 1;
    nodes += i > 58 ? ",{}" : fmt::format(",{{\"children\":[{},{}]}}", next, next + 1);
  }
  EXPECT_THAT(refusal(changed("\"nodes\":[{\"mesh\":0}", nodes)), HasSubstr("has two parents"));
}

}  // namespace
}  // namespace palpate
