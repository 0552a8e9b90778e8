// Which side is outside: normals of one component agree, outward where nothing else is known of
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "geometry/clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/given_normals.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;
using test::Clouds;
using test::Points;

/// Share of the points on segments whose normal is on the side of outward(point).
template <class Outward>
double share_right(const SurfacePoints& points, const Outward& outward) {
  double right = 0;
  double all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f direction = outward(points.grid.points()[i]);
    if (points.segments.segment[i] == SurfacePoints::Segments::kNone || direction.isZero(0))
      continue;
    ++all;
    if (points.normals[i].dot(direction) > 0) ++right;
  }
  EXPECT_GT(all, 0.9 * static_cast<double>(points.size()));
  return right / all;
}

PointCloud cloud_of(Points points) {
  PointCloud cloud;
  cloud.positions = std::move(points);
  return cloud;
}

SurfacePoints prepared(Points points, const PrepareOptions& options = {}) {
  return prepare(cloud_of(std::move(points)), options).points;
}

/// A sphere of random points whose normals point inward, which nothing but these can tell.
PointCloud inward_sphere() {
  PointCloud cloud = cloud_of(Clouds(4).sphere(4000, 0.1));
  for (const Vector3f& p : cloud.positions) cloud.normals.push_back(-p.normalized());
  return cloud;
}

double share_outward(const PointCloud& cloud, const PrepareOptions& options = {}) {
  return share_right(prepare(cloud, options).points, [](const Vector3f& p) { return p; });
}

TEST(Signs, OfSpheresAndATorusAreOutward) {
  const Vector3f center(5, -3, 2);
  Clouds clouds;
  Points points = clouds.sphere(3000, 1, center.cast<double>());
  EXPECT_EQ(share_right(prepared(points), [&](const Vector3f& p) { return Vector3f(p - center); }),
            1);
  for (const Vector3f& p : clouds.sphere(1000, 0.3)) points.push_back(p);  // another object
  EXPECT_EQ(
      share_right(prepared(points),
                  [&](const Vector3f& p) { return p.norm() < 0.5f ? p : Vector3f(p - center); }),
      1);
  const auto from_tube = [](const Vector3f& p) {
    const float r = std::hypot(p.x(), p.y());
    return Vector3f(p.x() - p.x() / r, p.y() - p.y() / r, p.z());
  };
  EXPECT_EQ(share_right(prepared(clouds.torus(160, 50, 1, 0.3)), from_tube), 1);
}

TEST(Signs, OfTheSidesOfAThinPlateAreOpposite) {
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
  const SurfacePoints plate = prepared(points);
  double right = 0;
  double all = 0;
  for (std::size_t i = 0; i < plate.size(); ++i) {
    const Vector3f& p = plate.grid.points()[i];
    const bool face = p.z() < s / 2 || p.z() > thickness - s / 2;
    if (!face || std::abs(plate.normals[i].z()) < 0.9f) continue;  // the rim and its corners
    ++all;
    if (plate.normals[i].z() * (p.z() - thickness / 2) > 0) ++right;
  }
  EXPECT_GT(all, 2 * 49 * 49);
  EXPECT_GT(right / all, 0.999);
}

TEST(Signs, OfTerrainAreUpAndOfAWallAwayFromTheMiddle) {
  Clouds clouds;
  Points terrain = clouds.plane(60, 1, 0.2);
  for (Vector3f& p : terrain) p.z() = 3 * std::sin(0.2f * p.x()) * std::sin(0.15f * p.y());
  const Vector3f up(0, 0, 1);
  EXPECT_EQ(share_right(prepared(terrain), [&](const Vector3f&) { return up; }), 1);
  Points walls;
  for (const Vector3f& p : clouds.plane(30, 1, 0.2)) {
    walls.push_back(Vector3f(100, p.x(), p.y()));
    walls.push_back(Vector3f(-100, p.x(), p.y()));
  }
  EXPECT_EQ(share_right(prepared(walls), [](const Vector3f& p) { return Vector3f(p.x(), 0, 0); }),
            1);
}

TEST(Signs, OfAViewAreTowardsTheViewpoint) {
  PointCloud view = cloud_of(Clouds().plane(40, 0.01, 0.2));
  view.viewpoint = Eigen::Vector3d(0.2, 0.2, -1);  // from below
  const auto up = [](const Vector3f&) { return Vector3f(0, 0, 1); };
  EXPECT_EQ(share_right(prepare(view).points, up), 0);
  EXPECT_EQ(share_right(
                prepare(view, {.orientation = PrepareOptions::Orientation::viewpoint}).points, up),
            0);
  EXPECT_EQ(
      share_right(prepare(view, {.orientation = PrepareOptions::Orientation::outward}).points, up),
      1);
  for (std::size_t i = 0; i < view.size(); ++i) view.normals.emplace_back(0, 0, 1);
  EXPECT_EQ(share_right(prepare(view).points, up), 1) << "given signs come first";
  const PrepareOptions asked{.viewpoint = Eigen::Vector3d(0.2, 0.2, -2)};
  EXPECT_EQ(share_right(prepare(view, asked).points, up), 0) << "but for a viewpoint asked for";
  for (Vector3f& normal : view.normals) normal.z() = -1;
  const PrepareOptions both{.viewpoint = Eigen::Vector3d(0.2, 0.2, 2),
                            .orientation = PrepareOptions::Orientation::given};
  EXPECT_EQ(share_right(prepare(view, both).points, up), 0) << "unless they alone are asked for";
}

TEST(GivenSigns, CountsWhatIsThere) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(share_given({}), 0);
  const std::vector<Vector3f> normals = {{0, 0, 1}, {0, 0, 0}, {nan, 0, 1}, {0, -1e-3f, 0}};
  EXPECT_EQ(share_given(normals), 0.5);
}

TEST(GivenSigns, MissingOnesFollowTheirSegment) {
  PointCloud cloud = inward_sphere();
  EXPECT_EQ(share_outward(cloud), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].z() > 0) cloud.normals[i].setConstant(NAN);
  }
  EXPECT_EQ(share_outward(cloud), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % 8 != 0) cloud.normals[i].setZero();
  }
  EXPECT_EQ(share_outward(cloud, {.orientation = PrepareOptions::Orientation::given}), 0);
}

TEST(GivenSigns, ThatContradictEachOtherSayNothing) {
  PointCloud cloud = inward_sphere();
  for (std::size_t i = 0; i < cloud.size(); i += 10) cloud.normals[i] = -cloud.normals[i];
  EXPECT_EQ(share_outward(cloud), 1);
  for (Vector3f& n : cloud.normals) n.setZero();
  EXPECT_EQ(share_outward(cloud), 1);
  EXPECT_THROW((void)prepare(cloud, {.orientation = PrepareOptions::Orientation::given}), Error);
}

/// A wavy sheet of which a camera at the origin sees the waves' backs, too, as noise of stereo
/// shows them that is as long as its windows. It leans towards the camera.
PointCloud grazed_waves(const Vector3f& normal) {
  PointCloud cloud = cloud_of(Clouds(6).plane(80, 5e-3));
  const Vector3f along = Vector3f::UnitX().cross(normal);
  for (Vector3f& p : cloud.positions) {
    const float height = 2.5e-3f * std::sin(80 * p.y());
    p = Vector3f(p.x() - 0.2f, -0.2f, 1) + (p.y() - 0.2f) * along + height * normal;
  }
  cloud.viewpoint = Eigen::Vector3d::Zero();
  return cloud;
}

// Where nothing is known +z counts as up: in a camera's frame the back of what it sees.
TEST(SeenSigns, CountWhereMostOfThemAgree) {
  const Vector3f normal = Vector3f(0, -1, -0.3f).normalized();
  const auto outward = [&](const Vector3f&) { return normal; };
  EXPECT_EQ(share_right(prepare(grazed_waves(normal)).points, outward), 1);
}

TEST(GivenSigns, DoNotReachOtherObjects) {
  PointCloud cloud = inward_sphere();
  const std::size_t near = cloud.size();
  for (std::size_t i = 0; i < near; ++i) {
    cloud.positions.push_back(cloud.positions[i] + Vector3f(1, 0, 0));
    cloud.normals.push_back(Vector3f::Zero());
  }
  const auto told = [](const Vector3f& p) {
    return p.x() > 0.5f ? Vector3f(p - Vector3f(1, 0, 0)) : Vector3f(-p);
  };
  EXPECT_EQ(share_right(prepare(cloud).points, told), 1);
}

TEST(Signs, KeepDegenerateCloudsFinite) {
  for (const Points& points : {Points(1, Vector3f(1, 2, 3)), Points(400, Vector3f(1, 2, 3))}) {
    const auto normals = prepared(points).normals;
    EXPECT_FALSE(normals.empty());
    for (const Vector3f& n : normals) EXPECT_TRUE(n.isZero());
  }
}

TEST(Signs, DoNotDependOnTheNumberOfThreads) {
  const Points points = Clouds(6).sphere(20000, 1);
  const SurfacePoints many = prepared(points);
  const ThreadLimit one(1);
  const SurfacePoints few = prepared(points);
  EXPECT_EQ(many.normals, few.normals);
  EXPECT_EQ(many.segments.segment, few.segments.segment);
  EXPECT_EQ(many.segments.component, few.segments.component);
}

/// Vertices and, from the faces, their outward directions.
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

TEST(Signs, OfTheBunnyAreThoseOfItsMesh) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  Points points, directions;
  const auto path = std::filesystem::path(data) / "stanford_bunny" / "bun_zipper.ply";
  if (!read_mesh(path, points, directions)) GTEST_SKIP() << path << " is not there";
  const CellGrid mesh(points);
  const auto outward = [&](const Vector3f& p) {
    std::vector<CellGrid::Neighbor> nearest;
    mesh.nearest(p, 1, nearest);
    return directions[mesh.order()[nearest.front().index]];  // zero: in no face
  };
  EXPECT_GT(share_right(prepared(points, {.voxel = 0.0}), outward), 0.995);
}

}  // namespace
}  // namespace palpate
