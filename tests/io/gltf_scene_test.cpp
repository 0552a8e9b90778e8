// Vertices of glTF scenes that joints, morph targets and instances move, and what is left out of a
// scene.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "io/reading.hpp"
#include "support/effort.hpp"
#include "support/mesh_files.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

// Two triangles in the plane z = 0 of palpate, 2 m wide and 1 m long.
const test::TestMesh kPlate{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};

// Numbers that accessor 2 and those after it name.
struct Numbers {
  std::string type;
  int component;
  std::size_t count;
  std::string bytes;
};

Numbers floats(const std::string& type, std::size_t count, const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) append(bytes, value);
  return {type, 5126, count, bytes};
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

// The plate as GLB: its nodes, what else its primitive and its file have.
std::string plate(const std::string& nodes, const std::string& primitive,
                  const std::vector<Numbers>& numbers = {}, const std::string& more = "") {
  std::string json = test::gltf_json(kPlate);
  std::string data = test::gltf_data(kPlate);
  std::string accessors;
  std::string views;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    accessors += fmt::format(R"(,{{"bufferView":{},"componentType":{},"count":{},"type":"{}"}})",
                             2 + i, numbers[i].component, numbers[i].count, numbers[i].type);
    views += fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}}})", data.size(),
                         numbers[i].bytes.size());
    data += numbers[i].bytes;
  }
  replace(json, R"("nodes":[{"mesh":0}])", "\"nodes\":[" + nodes + "]" + more);
  replace(json, R"("attributes":{"POSITION":0})", primitive);
  replace(json, R"(],"bufferViews")", accessors + R"(],"bufferViews")");
  replace(json, R"(],"buffers")", views + R"(],"buffers")");
  return test::glb(json, data);
}

void expect_box(const std::string& bytes, const Vector3d& lower, const Vector3d& upper) {
  const CloudFile file = read_text(bytes, "a.glb");
  Box box;
  for (std::size_t i = 0; i < file.cloud.size(); ++i) box.extend(file.cloud.point(i));
  EXPECT_LT((box.lower - lower).norm() + (box.upper - upper).norm(), 0.02 + 0.01 * upper.norm())
      << box.lower.transpose() << ", " << box.upper.transpose();
}

const std::string kPositions = R"("attributes":{"POSITION":0})";
const std::string kBound = R"("attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3})";

// Each vertex goes with joint 0 by `first` of its weight, and with joint 1.
std::vector<Numbers> shares(float first) {
  std::string joints;
  std::vector<float> weights;
  for (int i = 0; i < 4; ++i) {
    joints += std::string("\0\1\0\0", 4);
    weights.insert(weights.end(), {first, 1 - first, 0, 0});
  }
  return {{"VEC4", 5121, 4, joints}, floats("VEC4", 4, weights)};
}

TEST(GltfScene, JointsPlaceASkinWhereverItsNodeIs) {
  const std::string nodes = R"({"mesh":0,"skin":0,"scale":[100,100,100],"children":[1,2]},{},)"
                            R"({"translation":[0,0.03,0],"scale":[0.02,0.02,0.02]})";
  const std::string skins = R"(,"skins":[{"joints":[1,2]}])";
  // Joint 2 is 3 m high, and as its parent it is 100 times as large.
  expect_box(plate(nodes, kBound, shares(0), skins), {0, 0, 3}, {4, 2, 3});
  expect_box(plate(nodes, kBound, shares(1), skins), {0, 0, 0}, {200, 100, 0});
  expect_box(plate(nodes, kPositions, {}, skins), {0, 0, 0}, {2, 1, 0});  // no vertex names a joint
  std::vector<Numbers> numbers = shares(0);
  numbers.push_back(floats("MAT4", 2, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}));
  const std::string bound = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":4}])";
  expect_box(plate(nodes, kBound, numbers, bound), {10, 0, 3}, {14, 2, 3});
}

TEST(GltfScene, JointsBesideTheSceneHaveTheirPlaces) {
  const std::string nodes =
      R"({"mesh":0,"skin":0},{"children":[2],"scale":[2,2,2]},{"translation":[1,0,0]})";
  // The scene has the first node alone.
  expect_box(plate(nodes, kBound, shares(0), R"(,"skins":[{"joints":[1,2]}])"), {2, 0, 0},
             {6, 2, 0});
}

TEST(GltfScene, InstancesAreLimited) {
  const Numbers rows{"SCALAR", 5121, 4'000'000, std::string(4'000'000, '\1')};
  const std::string node = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":)"
                           R"({"attributes":{"TRANSLATION":2}}}})";
  EXPECT_THAT(refusal(plate(node, kPositions, {rows}), "a.glb"),
              HasSubstr("more than 3 million instances"));
}

TEST(GltfScene, MorphTargetsShiftByTheirWeights) {
  const Numbers up = floats("VEC3", 4, {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0});
  const std::string targets = kPositions + R"(,"targets":[{"POSITION":2},{"NORMAL":2}])";
  expect_box(plate(R"({"mesh":0})", targets, {up}), {0, 0, 0}, {2, 1, 0});
  expect_box(plate(R"({"mesh":0,"weights":[0.5,1]})", targets, {up}), {0, 0, 0.5}, {2, 1, 0.5});
}

TEST(GltfScene, InstancesAreThereAsOftenAsTheyAreNamed) {
  const std::string node =
      R"({"mesh":0,"translation":[1,0,0],"extensions":{"EXT_mesh_gpu_instancing":)"
      R"({"attributes":{"TRANSLATION":2,"SCALE":3}}}})";
  const std::string bytes =
      plate(node, kPositions,
            {floats("VEC3", 2, {0, 0, 0, 7, 0, 0}), floats("VEC3", 2, {1, 1, 1, 1, 1, 2})},
            R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])");
  EXPECT_EQ(read_text(bytes).mesh->triangles, 4u);
  expect_box(bytes, {1, 0, 0}, {10, 2, 0});
}

TEST(GltfScene, SaysWhatIsLeftOut) {
  const auto format = [](const std::string& primitive, const std::string& more = "") {
    return read_text(plate(R"({"mesh":0})", primitive, {}, more), "a.glb").format;
  };
  EXPECT_EQ(format(kPositions), "glTF, binary");
  EXPECT_THAT(format(kPositions, R"(,"animations":[{}])"), HasSubstr("without its animations"));
  EXPECT_THAT(format(kPositions + R"(,"mode":0,"extensions":{"KHR_gaussian_splatting":{}})"),
              HasSubstr("of Gaussian splats the centres alone"));
  const std::string lines = kPositions + R"(},{"mode":1,)" + kPositions;
  EXPECT_THAT(format(lines), HasSubstr("without its lines"));
  const std::string points = kPositions + R"(},{"mode":0,)" + kPositions;
  EXPECT_THAT(format(points), HasSubstr("without its points"));
  EXPECT_THAT(read_text(test::glb(
                            [] {
                              std::string json = test::gltf_json(kPlate);
                              replace(json, R"("scenes":[)", R"("scenes":[{"nodes":[0]},)");
                              return json;
                            }(),
                            test::gltf_data(kPlate)))
                  .format,
              HasSubstr("one of 2 scenes"));
}

TEST(GltfScene, RefusesWhatIsNotThere) {
  const std::string nodes = R"({"mesh":0,"skin":0},{})";
  EXPECT_THAT(refusal(plate(nodes, kBound, shares(0), R"(,"skins":[{"joints":[1]}])")),
              HasSubstr("names joint 1 of 1"));
  EXPECT_THAT(refusal(plate(nodes, kBound, shares(0), R"(,"skins":[{"joints":[1,7]}])")),
              HasSubstr("\"nodes\" has 2 elements"));
  EXPECT_THAT(
      refusal(plate(nodes, kBound, {shares(0)[0], floats("VEC3", 4, std::vector<float>(12))},
                    R"(,"skins":[{"joints":[1,1]}])")),
      HasSubstr("not four numbers a vertex"));
  const std::string targets = kPositions + R"(,"targets":[{"POSITION":2}])";
  EXPECT_THAT(
      refusal(plate(R"({"mesh":0,"weights":[1]})", targets, {floats("VEC3", 1, {0, 1, 0})})),
      HasSubstr("morph targets"));
}

// Cuts and flips: read or refused, and every point that is kept is finite.
TEST(GltfScene, DamagedScenesAreReadOrRefused) {
  const std::string whole =
      plate(R"({"mesh":0,"skin":0,"weights":[1],"extensions":{"EXT_mesh_gpu_instancing":)"
            R"({"attributes":{"TRANSLATION":4}}}},{"scale":[2,2,2]})",
            kBound + R"(,"targets":[{"POSITION":5}])",
            {shares(0.5F)[0], shares(0.5F)[1], floats("VEC3", 2, {0, 0, 0, 7, 0, 0}),
             floats("VEC3", 4, std::vector<float>(12, 1))},
            R"(,"skins":[{"joints":[1,1]}])");
  std::mt19937 random(78);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
  for (int i = 0; i < test::effort(2000); ++i) {
    std::string bytes = whole;
    const std::size_t at = random() % bytes.size();
    if (i % 2 == 0) bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
    if (i % 2 == 1) bytes.resize(at);
    try {
      const CloudFile file = read_text(bytes, "a.glb", {.mesh_spacing = 0.5});
      for (const Eigen::Vector3f& p : file.cloud.positions) ASSERT_TRUE(p.allFinite()) << i;
    } catch (const Error& error) {
      ASSERT_NE(std::string(error.what()), "") << i;
    }
  }
}

}  // namespace
}  // namespace palpate
