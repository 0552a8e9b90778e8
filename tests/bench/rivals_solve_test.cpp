// What god-objects are made of: the solve on up to three planes, and the first triangle on a way.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "rivals/frame_mesh.hpp"
#include "rivals/half_spaces.hpp"
#include "support/folder.hpp"
#include "support/peer_test.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

Vector3d normal_vector(Random& random) {
  return {random.normal(), random.normal(), random.normal()};
}

std::vector<Vector3d> some_planes(Random& random, std::size_t count) {
  std::vector<Vector3d> normals;
  for (std::size_t i = 0; i < count; ++i) normals.push_back(normal_vector(random).normalized());
  return normals;
}

// x is the nearest point where and only where goal - x is a sum of the planes it lies on, pulling
// inward alone.
bool is_nearest(const std::vector<Vector3d>& normals, const Vector3d& goal, const Vector3d& x) {
  Eigen::Matrix3Xd active(3, 0);
  for (const Vector3d& n : normals) {
    if (n.dot(x) < -1e-10) return false;
    if (n.dot(x) > 1e-10) continue;
    active.conservativeResize(3, active.cols() + 1);
    active.rightCols(1) = n;
  }
  if (active.cols() == 0) return (goal - x).norm() < 1e-10;
  const Eigen::VectorXd pulls = active.colPivHouseholderQr().solve(goal - x);
  return (active * pulls - (goal - x)).norm() < 1e-9 && pulls.maxCoeff() < 1e-9;
}

TEST(Rivals, GodObjectsGoToTheNearestAllowedPoint) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const std::vector<Vector3d> normals = some_planes(random, 1 + random.bits() % 3);
    const Vector3d goal = normal_vector(random);
    EXPECT_TRUE(is_nearest(normals, goal, nearest_allowed(normals, goal))) << i;
  }
}

TEST(Rivals, GodObjectsSolveAsSlsqpDoes) {
  Random random(4);
  std::string text;
  const auto write = [&](const Vector3d& x) {
    text += fmt::format("{} {} {} ", x.x(), x.y(), x.z());
  };
  for (int i = 0; i < 1000; ++i) {
    const std::vector<Vector3d> normals = some_planes(random, 1 + random.bits() % 3);
    const Vector3d goal = normal_vector(random);
    write(goal);
    write(nearest_allowed(normals, goal));
    for (const Vector3d& n : normals) write(n);
    text += '\n';
  }
  const test::Folder folder;
  folder.write("solved", text);
  const int status = std::system(
      fmt::format("/usr/bin/python3 {} {} >{}", PALPATE_SLSQP, folder / "solved", folder / "worst")
          .c_str());
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "SciPy is absent (Debian: python3-scipy)";
  ASSERT_EQ(status, 0);
  EXPECT_LT(std::stod(folder.read("worst")), 1e-8);
}

// A noisy image with holes and jumps.
DepthFrame rough_frame(Random& random) {
  DepthFrame frame;
  frame.camera = {40, 30, {50, 50, 20, 15}, {}};
  for (int i = 0; i < 40 * 30; ++i) {
    const double z = (i % 40 < 25 ? 0.5 : 0.7) + 0.01 * random.normal();
    frame.depth.push_back(random.uniform() < 0.03 ? 0 : static_cast<float>(z));
  }
  return frame;
}

std::vector<FrameMesh::Triangle> all_triangles(const FrameMesh& mesh) {
  std::vector<FrameMesh::Triangle> all;
  std::vector<FrameMesh::Triangle> around;
  for (int i = 0; i < mesh.vertices(); ++i) {
    mesh.triangles_at(i, around);
    for (const FrameMesh::Triangle& t : around) {
      if (*std::ranges::min_element(t) == i) all.push_back(t);
    }
  }
  return all;
}

// The share of the way at which the triangle's front is met, by Cramer's rule.
std::optional<double> met_at(const FrameMesh& mesh, const FrameMesh::Triangle& t,
                             const Vector3d& from, const Vector3d& to) {
  Eigen::Matrix3d columns;
  columns << mesh.at(t[1]) - mesh.at(t[0]), mesh.at(t[2]) - mesh.at(t[0]), from - to;
  if (mesh.normal(t).dot(to - from) >= 0) return std::nullopt;
  const Vector3d x = columns.inverse() * (from - mesh.at(t[0]));
  const bool inside = x.x() >= 0 && x.y() >= 0 && x.x() + x.y() <= 1 && x.z() >= 0 && x.z() <= 1;
  return inside ? std::optional(x.z()) : std::nullopt;
}

// Neither end is nearer to the sensor than anything can be seen.
std::pair<Vector3d, Vector3d> some_way(Random& random) {
  const Vector3d from(0.3 * random.normal(), 0.2 * random.normal(), 0.45 + 0.2 * random.uniform());
  Vector3d to = from + 0.2 * normal_vector(random);
  to.z() = std::max(to.z(), 0.02);
  return {from, to};
}

TEST(Rivals, FirstTriangleOnAWayIsThatOfAllTriangles) {
  Random random(9);
  const FrameMesh mesh(rough_frame(random), 5);
  const std::vector<FrameMesh::Triangle> all = all_triangles(mesh);
  ASSERT_GT(all.size(), 1000u);
  int met = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto [from, to] = some_way(random);
    double first = 2;
    for (const FrameMesh::Triangle& t : all)
      first = std::min(first, met_at(mesh, t, from, to).value_or(2));
    const auto found = mesh.first_met(from, to, {});
    ASSERT_EQ(found.has_value(), first <= 1) << i;
    if (!found) continue;
    ++met;
    ASSERT_NEAR((found->crossing - (from + first * (to - from))).norm(), 0, 1e-9) << i;
  }
  EXPECT_GT(met, 500);
}

class RivalsPeer : public test::PeerTest {
 protected:
  RivalsPeer() : PeerTest("three-mesh-bvh") {}
};

TEST_F(RivalsPeer, FirstTriangleOnAWayIsThatOfThreeMeshBvh) {
  Random random(10);
  const FrameMesh mesh(rough_frame(random), 5);
  const std::vector<FrameMesh::Triangle> all = all_triangles(mesh);
  std::vector<Vector3d> vertices;
  std::vector<std::pair<Vector3d, Vector3d>> ways;
  for (int i = 0; i < mesh.vertices(); ++i) vertices.push_back(mesh.at(i));
  for (int i = 0; i < 10000; ++i) ways.push_back(some_way(random));
  const auto flat = [](const Vector3d& x) { return fmt::format("{},{},{}", x.x(), x.y(), x.z()); };
  std::vector<std::string> places, ends;
  for (const Vector3d& x : vertices) places.push_back(flat(x));
  for (const auto& [from, to] : ways) ends.push_back(fmt::format("[{},{}]", flat(from), flat(to)));
  std::vector<std::string> corners;
  for (const auto& t : all) corners.push_back(fmt::format("{},{},{}", t[0], t[1], t[2]));
  folder_.write("scene.json",
                fmt::format(R"({{"vertices":[{}],"triangles":[{}],"ways":[{}]}})",
                            fmt::join(places, ","), fmt::join(corners, ","), fmt::join(ends, ",")));
  std::istringstream theirs(run("first_met.mjs", folder_ / "scene.json"));
  int met = 0;
  for (const auto& [from, to] : ways) {
    int number = 0;
    ASSERT_TRUE(theirs >> number);
    const auto found = mesh.first_met(from, to, {});
    ASSERT_EQ(found.has_value(), number >= 0);
    if (!found) continue;
    ++met;
    ASSERT_EQ(found->part, all[static_cast<std::size_t>(number)]);
  }
  EXPECT_GT(met, 500);
}

}  // namespace
}  // namespace palpate::rivals
