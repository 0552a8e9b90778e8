// Faces of every format are sampled evenly, up to their edges, and only where they say more than
// their vertices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/numbers.hpp"
#include "io/reading.hpp"
#include "support/effort.hpp"
#include "support/mesh_files.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::HasSubstr;

const test::TestMesh kCube = test::box_mesh(Vector3d::Constant(0.0625));

// Positions and normals in an order of their own.
std::vector<std::array<float, 6>> sorted_rows(const PointCloud& cloud) {
  std::vector<std::array<float, 6>> rows;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3f& p = cloud.positions[i];
    const Vector3f& n = cloud.normals[i];
    rows.push_back({p.x(), p.y(), p.z(), n.x(), n.y(), n.z()});
  }
  std::ranges::sort(rows);
  return rows;
}

TEST(Mesh, ACubeIsSampledEvenlyUpToItsEdges) {
  const CloudFile file = read_text(test::as_obj(kCube), "cube.obj");
  ASSERT_TRUE(file.mesh);
  EXPECT_EQ(file.mesh->triangles, 12u);
  EXPECT_EQ(file.declared, 8u);
  EXPECT_EQ(file.format, "OBJ");
  const double spacing = file.mesh->spacing;
  const auto along = static_cast<std::size_t>(std::ceil(0.125 / spacing));
  EXPECT_EQ(file.cloud.size(), 6 * along * along);
  EXPECT_GE(file.cloud.size(), 400'000u);
  const double half_cell = 0.0625 / static_cast<double>(along);
  Vector3f outermost = Vector3f::Zero();
  for (std::size_t i = 0; i < file.cloud.size(); ++i) {
    const Vector3f p = file.cloud.positions[i];
    int axis = 0;
    ASSERT_EQ(p.cwiseAbs().maxCoeff(&axis), 0.0625F);
    ASSERT_EQ(file.cloud.normals[i], Vector3f::Unit(axis) * (p[axis] > 0 ? 1 : -1));
    Vector3f inside = p.cwiseAbs();
    inside[axis] = 0;
    outermost = outermost.cwiseMax(inside);
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(static_cast<double>(outermost[axis]), 0.0625 - half_cell, 1e-8);
  }
}

TEST(Mesh, EveryFormatGivesTheSamePoints) {
  const auto expected = sorted_rows(read_text(test::as_obj(kCube)).cloud);
  for (const auto& [name, bytes] : test::as_every_format(kCube)) {
    const CloudFile file = read_text(bytes, name);
    ASSERT_TRUE(file.mesh) << name;
    EXPECT_EQ(file.mesh->triangles, 12u) << name;
    EXPECT_TRUE(sorted_rows(file.cloud) == expected) << name;
  }
}

TEST(Mesh, APolygonIsSampledAsItsTrianglesAre) {
  const std::string corners = "v 0 0 0\nv 2 0 0.5\nv 2 1 0.5\nv 1 1 0.25\nv 1 2 0.25\nv 0 2 0\n";
  const CloudFile polygon = read_text(corners + "f 1 2 3 4 5 6\n");
  const CloudFile triangles = read_text(corners + "f 1 2 4\nf 2 3 4\nf 1 4 6\nf 4 5 6\n");
  EXPECT_EQ(polygon.mesh->triangles, 4u);
  EXPECT_EQ(triangles.mesh->triangles, 4u);
  ASSERT_EQ(polygon.cloud.size(), triangles.cloud.size());
  const auto one = sorted_rows(polygon.cloud);
  const auto other = sorted_rows(triangles.cloud);
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) ASSERT_NEAR(one[i][k], other[i][k], 1e-6F);
  }
  for (const Vector3f& p : polygon.cloud.positions) ASSERT_FALSE(p.x() > 1 && p.y() > 1);
}

TEST(Mesh, SamplesLieInTheirFacesWhateverTheirDirection) {
  const test::TestMesh ball = test::icosphere(1, 1);
  const CloudFile file = read_text(test::as_stl(ball), "ball.stl");
  double area = 0;
  for (const auto& face : ball.faces) {
    const Vector3d a = ball.vertices[face[0]];
    area += (ball.vertices[face[1]] - a).cross(ball.vertices[face[2]] - a).norm() / 2;
  }
  for (std::size_t i = 0; i < file.cloud.size(); ++i) {
    double highest = -1;
    for (const auto& face : ball.faces) {
      const Vector3d a = ball.vertices[face[0]];
      const Vector3d n =
          (ball.vertices[face[1]] - a).cross(ball.vertices[face[2]] - a).normalized();
      highest = std::max(highest, n.dot(file.cloud.point(i) - a));
    }
    ASSERT_NEAR(highest, 0, 1e-6);  // it is on a face of the convex body, and above none
    ASSERT_GT(file.cloud.normals[i].dot(file.cloud.positions[i].normalized()), 0.9F);
  }
  // A sample stands for a cell as seen along an axis: for 1 to sqrt(3) cells of the face.
  const double cells = area / (file.mesh->spacing * file.mesh->spacing);
  EXPECT_LT(static_cast<double>(file.cloud.size()), 1.01 * cells);
  EXPECT_GT(static_cast<double>(file.cloud.size()), cells / std::sqrt(3));
}

TEST(Mesh, ColoursAndIntensitiesLieBetweenThoseOfTheCorners) {
  const CloudFile file = read_text(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float "
      "intensity\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0 9 1\n1 0 0 200 0 9 1\n0 1 0 0 100 9 3\n3 0 1 2\n");
  ASSERT_TRUE(file.mesh);
  ASSERT_EQ(file.cloud.colors.size(), file.cloud.size());
  for (std::size_t i = 0; i < file.cloud.size(); ++i) {
    const Vector3f p = file.cloud.positions[i];
    ASSERT_NEAR(file.cloud.colors[i][0], 200 * p.x(), 1);
    ASSERT_NEAR(file.cloud.colors[i][1], 100 * p.y(), 1);
    ASSERT_EQ(file.cloud.colors[i][2], 9);
    ASSERT_NEAR(file.cloud.intensities[i], 1 + 2 * p.y(), 1e-5F);
  }
}

TEST(Mesh, FacesThatAreNoneAreLeftOutAndCounted) {
  const CloudFile file = read_text(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 2 0 0\nv 0 0 0\n"
      "f 1 2 3\nf 3 2 1\nf 2 3 6\nf 1 2 4\nf 1 2 5\nf 1 2\nf 1 1 2\n");
  ASSERT_TRUE(file.mesh);
  EXPECT_EQ(file.mesh->triangles, 1u);
  EXPECT_EQ(file.mesh->duplicates, 2u);
  EXPECT_EQ(file.mesh->dropped, 4u);
}

TEST(Mesh, VerticesOfAMeshWithoutAFaceAreFelt) {
  const CloudFile file = read_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  ASSERT_TRUE(file.mesh);
  EXPECT_EQ(file.mesh->spacing, 0);
  EXPECT_EQ(file.cloud.size(), 3u);
  EXPECT_FALSE(read_text("v 0 0 0\nv 1 0 0\n").mesh);
}

TEST(Mesh, VerticesAsDenseAndEvenAsAScansAreFeltThemselves) {
  const test::TestMesh fine = test::icosphere(0.1, 5);
  const CloudFile scan = read_text(test::as_ply(fine));
  ASSERT_TRUE(scan.mesh);
  EXPECT_EQ(scan.mesh->spacing, 0);
  EXPECT_EQ(scan.mesh->triangles, 20480u);
  EXPECT_EQ(scan.cloud.size(), fine.vertices.size());
  EXPECT_TRUE(scan.cloud.normals.empty());
  EXPECT_GT(read_text(test::as_ply(test::icosphere(0.1, 3))).mesh->spacing, 0);
  // A large face among small ones says what no vertex does.
  test::TestMesh uneven = fine;
  uneven.vertices.insert(uneven.vertices.end(), {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}});
  const auto n = static_cast<std::uint32_t>(fine.vertices.size());
  uneven.faces.push_back({n, n + 1, n + 2});
  EXPECT_GT(read_text(test::as_ply(uneven)).mesh->spacing, 0);
}

TEST(Mesh, ASpacingThatIsGivenIsTaken) {
  const CloudFile file = read_text(test::as_obj(kCube), "a", {.scale = 2, .mesh_spacing = 0.01});
  EXPECT_DOUBLE_EQ(file.mesh->spacing, 0.01);
  EXPECT_EQ(file.cloud.size(), 6u * 25 * 25);
  EXPECT_THAT(refusal(test::as_obj(kCube), "a", {.mesh_spacing = 1e-9}),
              HasSubstr("more than 20 million points. Give a spacing of"));
  EXPECT_THAT(refusal("1 2 3\n", "a", {.mesh_spacing = -1}), HasSubstr("spacing of -1 m"));
  // What is thinner than a spacing has a row of samples in its middle.
  const test::TestMesh leaf = test::box_mesh({0.1, 0.1, 1e-4});
  EXPECT_EQ(read_text(test::as_obj(leaf), "a", {.mesh_spacing = 0.01}).cloud.size(),
            2u * 20 * 20 + 4 * 20);
}

// Bow ties have no area to speak of, and half of their box is inside of them.
TEST(Mesh, FacesThatNeedFarMoreSamplesThanTheirAreasSayAreRefused) {
  std::string ties;
  for (int i = 0; i < 200; ++i) {
    const double z = 1e-4 * i;
    ties +=
        fmt::format("v 0 0 {}\nv 1 1 {}\nv 1 0 {}\nv 0 1.000001 {}\nf -4 -3 -2 -1\n", z, z, z, z);
  }
  EXPECT_THAT(refusal(ties), HasSubstr("more than 4 million points where their areas ask for"));
  EXPECT_THAT(refusal(ties, "a", {.scale = 1, .mesh_spacing = 2e-5}),
              HasSubstr("more than 4 million points"));
}

TEST(Mesh, AFaceThatZigzagsWithoutEndIsRefused) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  std::string face = "f 5";
  for (int i = 0; i < 300'000; ++i) face += " 1 2 3 4";
  EXPECT_THAT(refusal("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0.5 0.7 0\n" + face + "\n"),
              HasSubstr("too many corners in a row"));
}

TEST(Mesh, NamesThePlaceOfWhatIsWrong) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(refusal(triangle + "f 1 2 4\n"),
              HasSubstr("line 4: a face has vertex \"4\", but there are 3"));
  EXPECT_THAT(refusal("v 0 0 0\nf -2 1 1\n"), HasSubstr("vertex \"-2\", but there are 1"));
  EXPECT_THAT(refusal(triangle + "f 1 2 x\n"), HasSubstr("line 4"));
  EXPECT_TRUE(read_text(triangle + "f -3/1 -2/2/7 -1//3 # all\n").mesh);
  std::string ply = test::as_ply(kCube);
  ply.replace(ply.rfind("3 1 7 3"), 7, "3 1 9 3");
  EXPECT_THAT(refusal(ply), HasSubstr("a face has vertex 9, but there are 8"));
  EXPECT_THAT(refusal(ply.substr(0, ply.size() - 5)), HasSubstr("ends after 11 of 12 rows"));
}

TEST(Stl, IsToldFromItsBytesOrItsName) {
  const std::string bytes = test::as_stl(kCube);
  EXPECT_EQ(read_text(bytes, "download").format, "STL, binary");
  EXPECT_EQ(read_text(test::as_stl_text(kCube), "download").format, "STL, ascii");
  EXPECT_THAT(refusal(bytes.substr(0, 300), "cut.stl"),
              HasSubstr("byte 300: the file ends after 4 of 12 triangles"));
  EXPECT_THAT(refusal(std::string(50, '\1'), "cut.stl"), HasSubstr("ends inside its STL header"));
  EXPECT_THAT(refusal(std::string(84, '\0'), "empty.stl"), HasSubstr("none of the 0 faces"));
}

TEST(Stl, LinesMayEndWithCrAndGiveColours) {
  const std::string text =
      "solid a\rcolor 1 0 0\rfacet normal 0 0 1\router loop\rvertex 0 0 0\rvertex 1 0 0\r"
      "vertex 0 1 0\rendloop\rendfacet\r";
  EXPECT_EQ(read_text(text + "endsolid a\r").mesh->triangles, 1u);
  EXPECT_THAT(refusal(text + "hello\r"), HasSubstr("line 10: unknown word \"hello\""));
}

TEST(Stl, NamesTheLineOfWhatIsWrong) {
  const std::string begin = "solid a\nfacet normal 0 0 1\nouter loop\nVertex 0 0 0\nvertex 1 0 0\n";
  EXPECT_THAT(refusal(begin + "vertex 1 one 0\n"), HasSubstr("line 6: \"one\" is not a number"));
  EXPECT_THAT(refusal(begin + "endloop\n"), HasSubstr("line 6: a face of 2 corners"));
  EXPECT_THAT(refusal(begin + "colour 1 2 3\n"), HasSubstr("unknown word \"colour\""));
  EXPECT_THAT(refusal(begin), HasSubstr("the file ends inside a face"));
  EXPECT_EQ(read_text(begin + "vertex 0 1 0\nendloop\nendfacet\nENDSOLID\n").mesh->triangles, 1u);
}

// There are as many as `PALPATE_TEST_EFFORT` asks for; each may be sampled in full.
TEST(Mesh, FilesWithWrongBytesEndInWordsOrACloud) {
  Random random(7);
  int read = 0;
  int refused = 0;
  for (const auto& [name, bytes] : test::as_every_format(kCube)) {
    for (int i = 0; i < test::effort(40); ++i) {
      std::string broken = bytes;
      for (std::uint64_t k = 0; k < 1 + random.bits() % 4; ++k) {
        broken[random.bits() % broken.size()] = static_cast<char>(random.bits());
      }
      if (random.bits() % 4 == 0) broken.resize(random.bits() % broken.size());
      try {
        const CloudFile file = read_text(broken, name);
        ASSERT_FALSE(file.cloud.empty()) << name;
        for (const Vector3f& p : file.cloud.positions) ASSERT_TRUE(p.allFinite()) << name;
        ++read;
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace palpate
