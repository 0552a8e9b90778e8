// Whose plane a point lies on: one that a third of the points around it lie on, too.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/clouds.hpp"
#include "refine/fitted.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

struct Made : test::Fitted {
  explicit Made(const std::vector<Vector3f>& points)
      : Fitted(points), snapped(snap_to_planes(input(), own)) {}

  Snapped snapped;
};

TEST(Snapping, GivesEdgesOfABoxThePlanesOfItsFaces) {
  std::vector<Vector3f> points;
  for (float a = 0; a <= 20; ++a) {
    for (float b = 0; b <= 20; ++b) {
      points.emplace_back(a, b, 0.f);
      if (b > 0) points.emplace_back(a, 0.f, b);
      if (a > 0 && b > 0) points.emplace_back(0.f, a, b);
    }
  }
  const Made made(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GE(made.own.confidences[i], 0.5f) << made.grid.points()[i].transpose();
    EXPECT_GT(made.own.normals[i].cwiseAbs().maxCoeff(), 0.99f);
  }
}

TEST(Snapping, PutsPointsOfACreaseOnTheConfidentPointsPlane) {
  const Made made(test::floor_and_wall(15));
  for (std::uint32_t i = 0; i < made.grid.size(); ++i) {
    const std::uint32_t owner = made.snapped.assigned[i];
    ASSERT_NE(owner, kUnassigned);
    EXPECT_EQ(made.snapped.confident[i] != 0, owner == i);
    const Vector3f off = made.grid.points()[i] - made.grid.points()[owner];
    EXPECT_LT(std::abs(made.own.normals[owner].dot(off)), 0.31f);
  }
}

TEST(Snapping, FindsAWallLowerThanRBetweenAFloorAndATread) {
  constexpr int kHeight = 3;  // 1.2 R: each point of the wall has the floor or the tread within R
  test::Clouds clouds(7);
  std::vector<Vector3f> points;
  const auto add = [&](double x, double y, double z) {
    points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  };
  const auto off = [&] { return clouds.uniform(0.3, 0.7); };
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 24; ++j) {
      add(i + off() - 12, j + off(), 0);
      add(i + off(), j + off(), kHeight);
      if (i < kHeight) add(0, j + off(), i + off());
    }
  }
  const Made made(points);
  int checked = 0;
  for (std::uint32_t i = 0; i < made.grid.size(); ++i) {
    const Vector3f& p = made.grid.points()[i];
    if (std::abs(p.x()) > 0.1f || p.y() < 3 || p.y() > 21) continue;
    if (p.z() < 0.8f || p.z() > kHeight - 0.8f) continue;
    EXPECT_GT(std::abs(made.own.normals[i].x()), 0.98f) << p.transpose();
    EXPECT_GE(made.own.confidences[i], 0.5f) << p.transpose();
    ++checked;
  }
  EXPECT_GE(checked, 15);
}

TEST(Snapping, LeavesNoisyPointsAPlaneWhereHardlyAnyIsConfident) {
  test::Clouds clouds(3);
  std::vector<Vector3f> points = clouds.plane(14, 1);
  for (Vector3f& p : points) p.z() = static_cast<float>(clouds.uniform(-0.8, 0.8));
  const Made made(points);
  std::size_t on_own = 0;
  for (std::uint32_t i = 0; i < made.grid.size(); ++i)
    on_own += made.snapped.assigned[i] == i ? 1 : 0;
  EXPECT_GT(2 * on_own, made.grid.size());
}

TEST(Snapping, LeavesBumpsFinerThanRWithoutAPlane) {
  std::vector<Vector3f> points;
  const float k = 2 * std::numbers::pi_v<float> / 4;
  for (float x = 0; x < 40; ++x) {
    for (float y = 0; y < 40; ++y) {
      points.emplace_back(x + 0.3f * std::sin(7 * y), y,
                          std::sin(k * x) * std::sin(k * (y + 0.4f)));
    }
  }
  const Made made(points);
  std::size_t reassigned = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t owner = made.snapped.assigned[i];
    if (owner == kUnassigned || owner == i) continue;
    ++reassigned;
    std::size_t on = 0;
    std::size_t all = 0;
    for (const Vector3f& q : made.grid.points()) {
      const Vector3f way = q - made.grid.points()[i];
      if (way.norm() > test::kFittedRadius) continue;
      ++all;
      if (std::abs(made.own.normals[owner].dot(way)) < 0.5f) ++on;
    }
    EXPECT_GE(3.4 * static_cast<double>(on), static_cast<double>(all));
  }
  EXPECT_LT(reassigned, points.size() / 2);
}

}  // namespace
}  // namespace palpate
