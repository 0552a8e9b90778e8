#include "geometry/normals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Clouds;
using test::Points;

// Eigen's own solver, double precision, sums about the mean.
Eigen::SelfAdjointEigenSolver<Matrix3d> oracle(const CellGrid& grid, std::uint32_t i, float radius,
                                               std::size_t& count) {
  std::vector<std::uint32_t> found;
  grid.within(grid.points()[i], radius, found);
  Vector3d mean = Vector3d::Zero();
  for (const auto k : found) mean += grid.points()[k].cast<double>();
  mean /= static_cast<double>(found.size());
  Matrix3d sum = Matrix3d::Zero();
  for (const auto k : found) {
    const Vector3d d = grid.points()[k].cast<double>() - mean;
    sum += d * d.transpose();
  }
  count = found.size();
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(sum / static_cast<double>(found.size()));
}

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) * 180 / 3.14159265358979;
}

TEST(Normals, AgreeWithEigensSolver) {
  for (const double offset : {0., 700.}) {  // m from the origin: float keeps 0.06 mm there
    Clouds clouds;
    const Points points = clouds.sphere(4000, 1, Vector3d(offset, -offset, 0));
    const CellGrid grid(points);
    const float radius = 0.15f;
    const Normals normals = estimate_normals(grid, radius);
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
      std::size_t count = 0;
      const auto expected = oracle(grid, i, radius, count);
      const Vector3d n = normals.normals[i].cast<double>();
      EXPECT_NEAR(n.norm(), 1, 1e-6);
      const Vector3d values = expected.eigenvalues();
      if (values[0] < 0.5 * values[1]) {
        EXPECT_LT(degrees_between(n, expected.eigenvectors().col(0)), 0.01);
      }
      const double dof = static_cast<double>(count) / (static_cast<double>(count) - 3);
      EXPECT_NEAR(normals.residuals[i], std::sqrt(std::max(0., values[0]) * dof), 2e-6);
    }
  }
}

TEST(Normals, OfAPlaneAreExactAndSure) {
  const CellGrid grid(Clouds(2).plane(40, 1e-3, 0.3));
  const Normals normals = estimate_normals(grid, 2.5e-3f);
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(std::abs(normals.normals[i].z()), 1, 1e-6);
    EXPECT_LT(normals.residuals[i], 1e-8f);
    EXPECT_EQ(normals.confidences[i], 1);
  }
}

TEST(Normals, ResidualsAreTheNoise) {
  Clouds clouds;
  Points points = clouds.plane(60, 2e-3);
  for (Vector3f& p : points) p.z() = static_cast<float>(clouds.uniform(-1, 1) * 1e-3);
  const auto residuals = estimate_normals(CellGrid(points), 8e-3f).residuals;
  double sum = 0;
  for (const float r : residuals) sum += static_cast<double>(r) * static_cast<double>(r);
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(residuals.size())), 1e-3 / std::sqrt(3.), 3e-5);
}

TEST(Normals, AreNotTrustedOnLinesInVolumesAndAlone) {
  Points line;
  Clouds clouds;
  for (int i = 0; i < 200; ++i) {
    line.push_back(Vector3f(1e-3f * static_cast<float>(i),
                            static_cast<float>(clouds.uniform(-1, 1) * 1e-4), 0));
  }
  for (const float c : estimate_normals(CellGrid(line), 5e-3f).confidences) EXPECT_EQ(c, 0);
  const auto volume = estimate_normals(CellGrid(clouds.cube(4000, 0.1)), 0.02f).confidences;
  EXPECT_LT(median(volume), 0.3);
  const Points four = clouds.plane(2, 1e-3);
  for (const float c : estimate_normals(CellGrid(four), 1).confidences) EXPECT_EQ(c, 0);
}

TEST(Normals, OfDegenerateNeighbourhoodsAreZeroAndNeverNaN) {
  Points line;
  for (int i = 0; i < 50; ++i) line.push_back(Vector3f(static_cast<float>(i), 0, 0));
  const std::vector<Points> inputs{Points(1, Vector3f(1, 2, 3)), Points(2, Vector3f(1, 2, 3)),
                                   Points(500, Vector3f(1e6f, 2, 3)), line};
  for (const Points& points : inputs) {
    const Normals normals = estimate_normals(CellGrid(points), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_TRUE(normals.normals[i].isZero()) << normals.normals[i];
      EXPECT_EQ(normals.confidences[i], 0);
      EXPECT_TRUE(std::isfinite(normals.residuals[i]));
    }
  }
  for (const float scale : {1e-18f, 1e-10f, 1e10f, 1e18f}) {
    Points points = Clouds(3).sphere(300, 1);
    for (Vector3f& p : points) p *= scale;
    const Normals normals = estimate_normals(CellGrid(points), 0.5f * scale);
    for (const Vector3f& n : normals.normals) EXPECT_TRUE(n.allFinite());
    for (const float r : normals.residuals) EXPECT_TRUE(std::isfinite(r));
  }
}

TEST(Normals, UseEachPointsOwnRadius) {
  const CellGrid grid(Clouds(4).sphere(2000, 1));
  std::vector<float> radii(grid.size());
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = 0.1f + 0.2f * static_cast<float>(i % 3);
  const Normals mixed = estimate_normals(grid, radii);
  for (const std::size_t kind : {0u, 1u, 2u}) {
    const Normals same = estimate_normals(grid, radii[kind]);
    for (std::size_t i = kind; i < radii.size(); i += 3) {
      EXPECT_EQ(mixed.normals[i], same.normals[i]);
      EXPECT_EQ(mixed.residuals[i], same.residuals[i]);
    }
  }
}

TEST(Normals, RefuseRadiiWithoutSense) {
  const CellGrid grid(Clouds(1).plane(3, 1));
  EXPECT_THROW((void)estimate_normals(grid, 0.f), Error);
  EXPECT_THROW((void)estimate_normals(grid, std::nanf("")), Error);
  EXPECT_THROW((void)estimate_normals(grid, std::vector<float>(8, 1.f)), Error);
}

}  // namespace
}  // namespace palpate
