// prepare() as a whole: what it finds, keeps and refuses.

#include "palpate/prepare/prepare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "palpate/base/error.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A sheet of 5 mm spacing, z = f(x, y) plus noise.
template <class Height>
PointCloud sheet(const Height& height, double noise, int half = 40) {
  std::mt19937 random(3);
  std::normal_distribution<double> error(0, 1);
  PointCloud cloud;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      const double x = 5e-3 * i + 0.5e-3 * error(random);
      const double y = 5e-3 * j + 0.5e-3 * error(random);
      const double z = height(x, y) + noise * error(random);
      cloud.positions.push_back(Vector3d(x, y, z).cast<float>());
    }
  }
  return cloud;
}

PointCloud flat(double noise = 0) {
  return sheet([](double, double) { return 0.0; }, noise);
}

TEST(Prepare, FindsSpacingAndNoise) {
  const Prepared::Report clean = prepare(flat()).report;
  EXPECT_NEAR(clean.spacing, 5e-3, 0.3e-3);
  EXPECT_LT(clean.noise, 1e-6);
  EXPECT_EQ(clean.voxel, 0);
  EXPECT_NEAR(clean.radius, 2.5 * clean.spacing, 0.3e-3);
  const Prepared::Report noisy = prepare(flat(2e-3)).report;
  EXPECT_NEAR(noisy.noise, 2e-3, 0.4e-3);
  EXPECT_GT(noisy.voxel, 0);
  EXPECT_GT(noisy.radius, 1.3 * clean.radius);
}

TEST(Prepare, ShapeIsNotNoise) {
  const auto waves = [](double x, double y) { return 5e-3 * std::sin(50 * x) * std::sin(50 * y); };
  const Prepared::Report report = prepare(sheet(waves, 0)).report;
  EXPECT_LT(report.noise, 0.1e-3);
  EXPECT_EQ(report.voxel, 0);
  EXPECT_LT(report.radius, 3.1 * report.spacing);
}

TEST(Prepare, EverySyntheticCloudKeepsItsShape) {
  for (const auto& [name, description] : synthetic_names()) {
    const Prepared::Report report = prepare(synthetic_cloud(name)).report;
    EXPECT_LT(report.radius, 4 * report.spacing) << name;
  }
}

TEST(Prepare, PutsTheCloudWhereItsPoseSays) {
  PointCloud cloud = flat();
  cloud.origin = {100, 0, 0};
  cloud.viewpoint = Vector3d(100, 0, 1);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  pose.pretranslate(Vector3d(0, 7, 0));
  const SurfacePoints points = prepare(cloud, {}, pose).points;
  EXPECT_LT((points.origin - pose * cloud.origin).norm(), 1e-9);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points.grid.points()[i].x(), 0, 1e-6);  // the sheet's z, turned
    EXPECT_GT(points.normals[i].x(), 0.99);             // towards the viewpoint
  }
}

// Noise that a given radius does not average leaves no point confident of its plane.
TEST(Prepare, NoisyPointsOfAGivenRadiusKeepTheirNormals) {
  const Prepared::Report report = prepare(flat(2e-3), {.paper = true}).report;
  EXPECT_LT(report.untrusted, 0.2);
}

TEST(Prepare, SpeckleWeighsNothing) {
  PointCloud cloud = flat();
  cloud.positions.emplace_back(0.0f, 0.0f, 0.1f);
  const Prepared prepared = prepare(cloud);
  EXPECT_EQ(prepared.report.speckle, 1u);
  EXPECT_EQ(prepared.report.points_out, cloud.size() - 1);
  for (std::size_t i = 0; i < prepared.points.size(); ++i) {
    const bool high = prepared.points.grid.points()[i].z() > 0.05f;
    EXPECT_EQ(prepared.points.density_weights[i] == 0, high);
  }
  EXPECT_EQ(prepare(cloud, {.remove_speckle = false}).report.speckle, 0u);
}

TEST(Prepare, PointsAtOnePlaceAreOne) {
  const PointCloud once = flat();
  PointCloud often = once;
  for (int k = 1; k < 70; ++k) {  // not so many that they go by blocks
    often.positions.insert(often.positions.end(), once.positions.begin(), once.positions.end());
  }
  const Prepared expected = prepare(once);
  const Prepared made = prepare(often);
  EXPECT_EQ(made.report.points_in, often.size());
  EXPECT_EQ(made.report.points_out, once.size());
  EXPECT_EQ(made.report.duplicates, often.size() - once.size());
  EXPECT_TRUE(std::ranges::equal(made.points.grid.points(), expected.points.grid.points()));
  EXPECT_EQ(made.points.radii, expected.points.radii);
  EXPECT_EQ(made.points.normals, expected.points.normals);
}

TEST(Prepare, IntensitiesBecomeMaterials) {
  PointCloud cloud = flat();
  for (const Vector3f& p : cloud.positions) cloud.intensities.push_back(100 + 1000 * p.x());
  const SurfacePoints points = prepare(cloud, {.material_from_intensity = true}).points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points.materials[i], (points.grid.points()[i].x() + 0.2) / 0.4, 0.02);
  }
}

// Red tells how far a point is along x: wherever the points went, their colours went, too.
TEST(Prepare, ColoursStayWithTheirPoints) {
  EXPECT_TRUE(prepare(flat()).points.colors.empty());
  PointCloud cloud = flat(1e-3);
  for (const Vector3f& p : cloud.positions) {
    cloud.colors.push_back({static_cast<std::uint8_t>(127 + 600 * p.x()), 40, 0});
  }
  const Box box{{-0.15, -0.15, -1}, {0.15, 0.15, 1}};
  for (const double voxel : {0.0, 12e-3}) {
    const SurfacePoints points = prepare(cloud, {.voxel = voxel, .clip = box}).points;
    ASSERT_EQ(points.colors.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(points.colors[i][0], 127 + 600 * points.grid.points()[i].x(), 1.6);
      EXPECT_EQ(points.colors[i][1], 40);
    }
  }
}

TEST(Prepare, TakesWhatItIsGiven) {
  const Prepared::Report report =
      prepare(flat(), {.voxel = 12e-3, .radius = 40e-3, .minimum_radius = 50e-3}).report;
  EXPECT_EQ(report.voxel, 12e-3);
  EXPECT_NEAR(report.radius, 50e-3, 1e-6);
  EXPECT_LT(report.points_out, 81 * 81 / 4);
  const Box box{{-0.1, -0.1, -1}, {0.1, 0.1, 1}};
  EXPECT_LT(prepare(flat(), {.clip = box}).report.points_out, 45u * 45u);
}

TEST(Prepare, ThePapersWayIsOneRadiusForAll) {
  const Prepared::Report report = prepare(flat(1e-3), {.paper = true}).report;
  EXPECT_EQ(report.voxel, 0);
  EXPECT_EQ(report.radius_smallest, report.radius_largest);
  EXPECT_NEAR(report.radius, 2.5 * report.spacing, 1e-6);
}

TEST(Prepare, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)prepare(PointCloud{}), Error);
  EXPECT_THROW((void)prepare(flat(), {.voxel = -1.0}), Error);
  EXPECT_THROW((void)prepare(flat(), {.radius = 0.0}), Error);
  EXPECT_THROW((void)prepare(flat(), {.smoothing = NAN}), Error);
  EXPECT_THROW((void)prepare(flat(), {.normal_error = 0}), Error);
  EXPECT_THROW((void)prepare(flat(), {.orientation = PrepareOptions::Orientation::viewpoint}),
               Error);
  EXPECT_THROW((void)prepare(flat(), {.orientation = PrepareOptions::Orientation::given}), Error);
  EXPECT_THROW((void)prepare(flat(), {.material_from_intensity = true}), Error);
  EXPECT_THROW((void)prepare(flat(), {.clip = Box{{5, 5, 5}, {6, 6, 6}}}), Error);
}

TEST(Prepare, RefusesCloudsThatAreNotWhole) {
  const auto refuses = [](const auto& spoil, const PrepareOptions& options = {}) {
    PointCloud cloud = flat();
    spoil(cloud);
    EXPECT_THROW((void)prepare(cloud, options), Error);
  };
  refuses([](PointCloud& c) { c.normals.resize(3); });
  refuses([](PointCloud& c) { c.colors.resize(c.size() + 1); });
  refuses([](PointCloud& c) { c.intensities.resize(3); });
  refuses([](PointCloud& c) { c.positions[7].y() = NAN; });
  refuses([](PointCloud& c) { c.origin.x() = NAN; });
  refuses([](PointCloud& c) { c.viewpoint = Vector3d(0, INFINITY, 0); });
  refuses([](PointCloud&) {}, {.viewpoint = Vector3d(0, NAN, 0)});
  const auto spoil_intensity = [](PointCloud& c) {
    c.intensities.assign(c.size(), 1.0f);
    c.intensities[9] = NAN;
  };
  refuses(spoil_intensity, {.material_from_intensity = true});
}

TEST(Prepare, RefusesPosesThatAreNotRigid) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = NAN;
  EXPECT_THROW((void)prepare(flat(), {}, pose), Error);
  pose.setIdentity();
  pose.linear() *= 1.01;
  EXPECT_THROW((void)prepare(flat(), {}, pose), Error);
  pose.setIdentity();
  pose.linear()(2, 2) = -1;
  EXPECT_THROW((void)prepare(flat(), {}, pose), Error);
  pose.linear()(2, 2) = 1 + 1e-7;  // a rotation that came from floats
  EXPECT_NO_THROW((void)prepare(flat(), {}, pose));
}

TEST(Prepare, FewPointsAreFelt) {
  for (int count = 1; count <= 6; ++count) {
    PointCloud cloud;
    for (int i = 0; i < count; ++i) cloud.positions.emplace_back(0.01f * i, 0.0f, 0.0f);
    const Prepared prepared = prepare(cloud);
    EXPECT_EQ(prepared.points.size(), static_cast<std::size_t>(count));
    EXPECT_TRUE(std::isfinite(prepared.report.radius) && prepared.report.radius > 0);
    EXPECT_GT(prepared.points.density_weights[0], 0);
  }
}

TEST(Prepare, PointsThatAreTooFewToTellAnAreaAreFeltWithinHalfOfTheirGaps) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {0.5f, 0, 0}, {0, 0.4f, 0.3f}};
  EXPECT_LE(prepare(cloud).report.radius_largest, 0.2501);
  for (int i = 0; i < 1000; ++i)
    cloud.positions.emplace_back(0.1f, 0.1f, 0.1f);  // all at one place
  EXPECT_LE(prepare(cloud).report.radius_largest, 0.2501);
}

}  // namespace
}  // namespace palpate
