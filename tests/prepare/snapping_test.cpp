// Whose plane a point lies on: one that a third of the points around it lie on, too.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "prepare/sheets.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr float kRadius = 2.5f;  // R; a spacing is 1

struct Made {
  CellGrid grid;
  std::vector<float> spacings;
  std::vector<float> radii;
  OwnSheets own;
  Snapped snapped;
};

Made snap(const std::vector<Vector3f>& points) {
  Made made{CellGrid(points), {}, {}, {}, {}};
  made.spacings.assign(points.size(), 1.f);
  made.radii.assign(points.size(), kRadius);
  const std::vector<float> noise(points.size(), 0.f);
  made.own = fit_own_sheets(made.grid, made.spacings, made.radii, noise);
  made.snapped = snap_to_planes({made.grid, made.spacings, made.radii, noise}, made.own);
  return made;
}

TEST(Snapping, GivesEdgesOfABoxThePlanesOfItsFaces) {
  std::vector<Vector3f> points;
  for (float a = 0; a <= 20; ++a) {
    for (float b = 0; b <= 20; ++b) {
      points.emplace_back(a, b, 0.f);
      if (b > 0) points.emplace_back(a, 0.f, b);
      if (a > 0 && b > 0) points.emplace_back(0.f, a, b);
    }
  }
  const Made made = snap(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GE(made.own.confidences[i], 0.5f) << made.grid.points()[i].transpose();
    EXPECT_GT(made.own.normals[i].cwiseAbs().maxCoeff(), 0.99f);
  }
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
  const Made made = snap(points);
  std::size_t hosted = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t host = made.snapped.hosts[i];
    if (host == kNoHost || host == i) continue;
    ++hosted;
    std::size_t on = 0;
    std::size_t all = 0;
    for (const Vector3f& q : made.grid.points()) {
      const Vector3f way = q - made.grid.points()[i];
      if (way.norm() > kRadius) continue;
      ++all;
      if (std::abs(made.own.normals[host].dot(way)) < 0.5f) ++on;
    }
    EXPECT_GE(3.4 * static_cast<double>(on), static_cast<double>(all));
  }
  EXPECT_LT(hosted, points.size() / 2);
}

}  // namespace
}  // namespace palpate
