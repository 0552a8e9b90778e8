#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "palpate/field/analytic.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/snapshots.hpp"
#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3f normal_of(const Mesh& mesh, const std::array<std::uint16_t, 3>& t) {
  const Vector3f a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

TEST(LocalSurface, OfABallIsClosedAndLooksOutward) {
  const SphereField ball(0.02);
  const Mesh mesh = local_surface(ball, {Vector3d::Zero(), 0.01, 0});
  ASSERT_GT(mesh.triangles.size(), 1000u);
  std::map<std::pair<std::uint16_t, std::uint16_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const Vector3f middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    EXPECT_GT(normal_of(mesh, t).dot(middle), 0);
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ((edges.count({edge.second, edge.first})), 1u) << "an open edge";
  }
  for (const Vector3f& v : mesh.vertices) EXPECT_NEAR(v.norm(), 0.02, 3e-4);
}

TEST(LocalSurface, ReachesAsFarAsItSaysAroundItsCenter) {
  const PlaneField plane;
  const Vector3d center(5, -3, 0.001);
  const Mesh mesh = local_surface(plane, {center, 0.01, 0});
  Vector3f lower = Vector3f::Zero();
  Vector3f upper = Vector3f::Zero();
  for (const Vector3f& v : mesh.vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
    EXPECT_NEAR(v.z(), -0.001, 1e-6);
  }
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(lower[axis], -kReach * 0.01, 2e-3);
    EXPECT_NEAR(upper[axis], kReach * 0.01, 2e-3);
  }
}

TEST(LocalSurface, OfNothingIsEmpty) {
  const PlaneField plane;
  EXPECT_TRUE(local_surface(plane, {{0, 0, 1}, 0.01, 0}).triangles.empty());
  EXPECT_TRUE(local_surface(plane, {{0, 0, -1}, 0.01, 0}).triangles.empty());
  EXPECT_TRUE(local_surface(plane, {{0, 0, 0}, 0, 0}).triangles.empty());
  EXPECT_TRUE(local_surface(plane, {{0, 0, NAN}, 0.01, 0}).triangles.empty());
}

TEST(LocalSurface, OfASheetShowsTheSideThatIsLookedAtAndNoBack) {
  Scene scene;
  scene.add("sheet").publish(test::still(test::plane(0)));
  for (const double side : {1.0, -1.0}) {
    SceneField field(scene);
    const Vector3d center(0, 0, 3e-3 * side);
    field.update_from(1, center, center);
    const Mesh mesh = local_surface(field, {center, 10e-3, 0.35});
    ASSERT_GT(mesh.triangles.size(), 500u);
    for (const Vector3f& v : mesh.vertices) EXPECT_NEAR(v.z() + center.z(), 0, 3e-4);
    for (const auto& t : mesh.triangles) EXPECT_GT(side * normal_of(mesh, t).z(), 0);
  }
}

}  // namespace
}  // namespace palpate::viewer
