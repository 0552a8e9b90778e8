#include "palpate/geometry/orientation.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "geometry/clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/normals.hpp"
#include "palpate/geometry/spacing.hpp"
#include "palpate/geometry/support.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;
using test::Clouds;
using test::Points;

struct Oriented {
  CellGrid grid;
  std::vector<Vector3f> normals;
};

Oriented orient(const Points& points) {
  Oriented result{CellGrid(points), {}};
  const auto spacings = local_spacings(result.grid);
  result.normals = estimate_normals(result.grid, support_radii(spacings)).normals;
  for (std::size_t i = 0; i < result.normals.size(); ++i) {  // signs that mean nothing
    if (i * 2654435761u % 7 < 3) result.normals[i] = -result.normals[i];
  }
  orient_outward(result.grid, spacings, result.normals);
  return result;
}

// Share of the points whose normal is on the side of outward(point).
template <class Outward>
double share_right(const Oriented& oriented, const Outward& outward) {
  double right = 0;
  for (std::size_t i = 0; i < oriented.normals.size(); ++i) {
    if (oriented.normals[i].dot(outward(oriented.grid.points()[i])) > 0) ++right;
  }
  return right / static_cast<double>(oriented.normals.size());
}

TEST(Orientation, ToAViewpointIsThatOfEachPointsOwnView) {
  Clouds clouds;
  const Points points = clouds.sphere(500, 1);
  std::vector<Vector3f> normals;
  for (std::size_t i = 0; i < points.size(); ++i)
    normals.push_back(clouds.direction().cast<float>());
  normals[3].setZero();
  const Vector3f viewpoint(0.1f, 3, -2);
  orient_to_viewpoint(points, viewpoint, normals);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GE(normals[i].dot(viewpoint - points[i]), 0);
  }
  EXPECT_TRUE(normals[3].isZero());
  EXPECT_THROW(orient_to_viewpoint(points, viewpoint, std::span(normals).first(3)), Error);
}

TEST(Orientation, OutwardOfSpheresAndATorus) {
  const Vector3f center(5, -3, 2);
  Clouds clouds;
  Points points = clouds.sphere(3000, 1, center.cast<double>());
  EXPECT_EQ(share_right(orient(points), [&](const Vector3f& p) { return Vector3f(p - center); }),
            1);
  for (const Vector3f& p : clouds.sphere(1000, 0.3)) points.push_back(p);  // another object
  EXPECT_EQ(
      share_right(orient(points),
                  [&](const Vector3f& p) { return p.norm() < 0.5f ? p : Vector3f(p - center); }),
      1);
  const auto from_tube = [](const Vector3f& p) {
    const float r = std::hypot(p.x(), p.y());
    return Vector3f(p.x() - p.x() / r, p.y() - p.y() / r, p.z());
  };
  EXPECT_EQ(share_right(orient(clouds.torus(160, 50, 1, 0.3)), from_tube), 1);
}

TEST(Orientation, GivesOppositeSidesOfAThinPlateOppositeNormals) {
  const float s = 2e-3f;
  const float thickness = 4 * s;
  Points points;
  for (const Vector3f& p : Clouds(1).plane(51, 2e-3)) {
    points.push_back(p);
    points.push_back(p + Vector3f(0, 0, thickness));
    const bool rim = p.x() < s / 2 || p.y() < s / 2 || p.x() > 49.5f * s || p.y() > 49.5f * s;
    for (int layer = 1; rim && layer < 4; ++layer) {
      points.push_back(p + Vector3f(0, 0, s * static_cast<float>(layer)));
    }
  }
  const auto away = [&](const Vector3f& p) { return Vector3f(0, 0, p.z() - thickness / 2); };
  const Oriented plate = orient(points);
  double right = 0;
  double all = 0;
  for (std::size_t i = 0; i < plate.normals.size(); ++i) {
    const Vector3f& p = plate.grid.points()[i];
    if (std::abs(away(p).z()) < thickness / 2 - s / 2) continue;  // the rim
    ++all;
    if (plate.normals[i].dot(away(p)) > 0) ++right;
  }
  EXPECT_GT(right / all, 0.999);
}

TEST(Orientation, OfTerrainIsUpAndOfAWallAwayFromTheMiddle) {
  Clouds clouds;
  Points terrain = clouds.plane(60, 1, 0.2);
  for (Vector3f& p : terrain) p.z() = 3 * std::sin(0.2f * p.x()) * std::sin(0.15f * p.y());
  const Vector3f up(0, 0, 1);
  EXPECT_EQ(share_right(orient(terrain), [&](const Vector3f&) { return up; }), 1);
  Points walls;
  for (const Vector3f& p : clouds.plane(30, 1, 0.2)) {
    walls.push_back(Vector3f(100, p.x(), p.y()));
    walls.push_back(Vector3f(-100, p.x(), p.y()));
  }
  EXPECT_EQ(share_right(orient(walls), [](const Vector3f& p) { return Vector3f(p.x(), 0, 0); }), 1);
}

TEST(Orientation, KeepsDegenerateCloudsFiniteAndZeroNormalsZero) {
  for (const Points& points :
       {Points{}, Points(1, Vector3f(1, 2, 3)), Points(400, Vector3f(1, 2, 3))}) {
    const Oriented oriented = orient(points);
    for (const Vector3f& n : oriented.normals) EXPECT_TRUE(n.isZero());
  }
  std::vector<Vector3f> normals(4, Vector3f(0, 0, 1));
  EXPECT_THROW(orient_outward(CellGrid(Clouds(1).plane(3, 1)), normals), Error);
}

TEST(Orientation, DoesNotDependOnTheNumberOfThreads) {
  const Points points = Clouds(6).sphere(20000, 1);
  const Oriented many = orient(points);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(many.normals, orient(points).normals);
}

// Vertices and, from the faces, their outward directions.
bool read_mesh(const std::filesystem::path& path, Points& points, Points& directions) {
  std::ifstream file(path);
  std::string line;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  while (std::getline(file, line) && line.rfind("end_header", 0) != 0) {
    std::istringstream words(line);
    std::string first, second;
    std::size_t count = 0;
    if (!(words >> first >> second >> count) || first != "element") continue;
    (second == "vertex" ? vertices : faces) = count;
  }
  points.assign(vertices, Vector3f::Zero());
  directions.assign(vertices, Vector3f::Zero());
  for (Vector3f& p : points) {
    std::getline(file, line);
    std::istringstream(line) >> p.x() >> p.y() >> p.z();
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::size_t corners = 0, a = 0, b = 0, c = 0;
    file >> corners >> a >> b >> c;
    const Vector3f n = (points[b] - points[a]).cross(points[c] - points[a]);
    for (const std::size_t v : {a, b, c}) directions[v] += n;
  }
  return !points.empty() && static_cast<bool>(file);
}

TEST(Orientation, OfTheBunnyIsThatOfItsMesh) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  Points points, directions;
  const auto path = std::filesystem::path(data) / "stanford_bunny" / "bun_zipper.ply";
  if (!read_mesh(path, points, directions)) GTEST_SKIP() << path << " is not there";
  const Oriented oriented = orient(points);
  double right = 0;
  double all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f& direction = directions[oriented.grid.order()[i]];
    if (direction.isZero(0)) continue;  // in no face
    ++all;
    if (direction.dot(oriented.normals[i]) > 0) ++right;
  }
  EXPECT_GT(right / all, 0.999);
}

}  // namespace
}  // namespace palpate
