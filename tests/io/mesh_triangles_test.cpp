// The faces of every format as triangles, in metres.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "support/folder.hpp"
#include "support/mesh_files.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

const test::TestMesh kBox = test::box_mesh(Vector3d(0.25, 0.5, 0.125));

std::string written(const test::Folder& folder, const std::string& name, const std::string& bytes) {
  const std::string path = folder / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// The sum of the triangles' areas as vectors, of their areas, and of the volumes over the origin.
struct Sums {
  Vector3d turned = Vector3d::Zero();
  double area = 0;
  double volume = 0;
};

Sums sums_of(const TriangleMesh& mesh) {
  Sums sums;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d twice = (mesh.vertices.at(b) - mesh.vertices.at(a))
                               .cross(mesh.vertices.at(c) - mesh.vertices.at(a));
    sums.turned += 0.5 * twice;
    sums.area += 0.5 * twice.norm();
    sums.volume += twice.dot(mesh.vertices.at(a)) / 6;
  }
  return sums;
}

std::string refused_mesh(const std::string& path) {
  try {
    (void)read_mesh(path, {.scale = 1});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeshTriangles, AreThoseOfTheBoxInEveryFormat) {
  const test::Folder folder;
  for (const auto& [name, bytes] : test::as_every_format(kBox)) {
    const TriangleMesh mesh = read_mesh(written(folder, name, bytes), {.scale = 2});
    EXPECT_EQ(mesh.triangles.size(), 12u) << name;
    const Sums sums = sums_of(mesh);
    EXPECT_NEAR(sums.turned.norm(), 0, 1e-6) << name;
    EXPECT_NEAR(sums.area, 4 * 2 * (0.5 * 1 + 1 * 0.25 + 0.25 * 0.5), 1e-6) << name;
    EXPECT_NEAR(sums.volume, 8 * 0.5 * 1 * 0.25, 1e-6) << name;
  }
}

TEST(MeshTriangles, APolygonIsCoveredFromACornerThatSeesAllOfIt) {
  const test::Folder folder;
  const std::string corners = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 9 9 nan\n";
  const Sums sums =
      sums_of(read_mesh(written(folder, "l.obj", corners + "f 1 2 3 4 5 6\n"), {.scale = 1}));
  EXPECT_NEAR(sums.area, 3, 1e-12);
  EXPECT_NEAR(sums.turned.z(), 3, 1e-12);
  const std::string comb =  // no corner sees both of its teeth
      "v 0 0 0\nv 9 0 0\nv 9 3 0\nv 8 3 0\nv 8 1 0\nv 5 1 0\nv 5 3 0\nv 4 3 0\nv 4 1 0\nv 1 1 0\n"
      "v 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 8 9 10 11 12\n";
  EXPECT_THAT(refused_mesh(written(folder, "comb.obj", comb)), HasSubstr("with triangles alone"));
}

TEST(MeshTriangles, WhatIsLeftOutIsCounted) {
  const test::Folder folder;
  const std::string faces =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 nan 1\nf 1 2 3\nf 2 3 1\nf 1 2 2\nf 1 2 4\n";
  const TriangleMesh mesh = read_mesh(written(folder, "a.obj", faces), {.scale = 1});
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.facts.triangles, 1u);
  EXPECT_EQ(mesh.facts.duplicates, 1u);
  EXPECT_EQ(mesh.facts.dropped, 2u);
}

TEST(MeshTriangles, OfAFileWithoutFacesThereAreNone) {
  const test::Folder folder;
  EXPECT_THAT(refused_mesh(written(folder, "a.obj", "v 0 0 0\nv 1 0 0\n")),
              HasSubstr("no faces in it"));
  EXPECT_THAT(refused_mesh(written(folder, "a.xyz", "0 0 0\n1 0 0\n")),
              HasSubstr("no faces in it"));
  EXPECT_THAT(refused_mesh(written(folder, "a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n")),
              HasSubstr("none of the 1 faces is finite and has an area"));
}

}  // namespace
}  // namespace palpate
