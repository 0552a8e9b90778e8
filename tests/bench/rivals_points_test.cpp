// Methods on points have to match their own theory.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers.hpp"
#include "peers/peers.hpp"
#include "rivals/mls.hpp"
#include "rivals/rival.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 2e-3;  // m between points
constexpr int kHalf = 40;

// A square grid in the plane of this height; normals as given, where they are.
void add_grid(PointCloud& cloud, double height, const Eigen::Vector3f* normal = nullptr) {
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      cloud.positions.push_back(Vector3d(i * kSide, j * kSide, height).cast<float>());
      if (normal != nullptr) cloud.normals.push_back(*normal);
    }
  }
}

PointCloud grid() {
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 1);
  add_grid(cloud, 0);
  return cloud;
}

std::unique_ptr<Rival> shown(const char* name, const PointCloud& cloud) {
  std::unique_ptr<Rival> rival = method_named(name).make(1);
  rival->show({nullptr, &cloud, kSide});
  return rival;
}

TEST(Rivals, HexahedraStepByStiffnessTimesSpacing) {
  const PointCloud cloud = grid();
  const std::unique_ptr<Rival> rival = shown("hexahedra", cloud);
  rival->reset({-0.03, 0.0003, 0.01});
  Vector3d last = rival->step({-0.03, 0.0003, -0.003}).force;
  int steps = 0;
  for (int i = 1; i < 4000; ++i) {
    const double move = 1e-5;
    const Vector3d force = rival->step({-0.03 + move * i, 0.0003, -0.003}).force;
    const double change = (force - last).norm();
    last = force;
    if (change < 1.01 * kStiffness * move) continue;
    ++steps;
    EXPECT_NEAR(change, kStiffness * kSide, 1.01 * kStiffness * move);
  }
  EXPECT_EQ(steps, 20);  // 40 mm
}

TEST(Rivals, HexahedraLetGoOfAHandThatGoesBack) {
  const PointCloud cloud = grid();
  const std::unique_ptr<Rival> rival = shown("hexahedra", cloud);
  rival->reset({0, 0, 0.01});
  EXPECT_FALSE(rival->step({0, 0, 0.005}).touching);
  EXPECT_NEAR(rival->step({0, 0, -0.02}).force.z(), kStiffness * 0.02, 1e-6);
  EXPECT_NEAR(rival->step({0.01, 0, -0.02}).force.z(), kStiffness * 0.02, 1e-6);
  EXPECT_FALSE(rival->step({0.01, 0, 0.005}).touching);
}

TEST(Rivals, MlsOfAPlaneIsThePlane) {
  const PointCloud cloud = grid();
  const NearPoints points(cloud);
  for (int i = 0; i < 50; ++i) {
    const Vector3d x(-0.02 + 7.1e-4 * i, 0.01 - 3.3e-4 * i, -0.003);
    const std::optional<MlsFoot> foot = project_mls(points, 2 * kSide, x);
    ASSERT_TRUE(foot);
    EXPECT_NEAR((foot->place - Vector3d(x.x(), x.y(), 0)).norm(), 0, 1e-9);
    EXPECT_NEAR((foot->normal - Vector3d::UnitZ()).norm(), 0, 1e-9);
  }
}

// PCL's weights end at 1/e. A disc of 1.5 widths spreads as far as ours do (root mean square).
TEST(Rivals, MlsProjectsAsPclDoes) {
  Random random(5);
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 1);
  add_grid(cloud, 0);
  for (Eigen::Vector3f& p : cloud.positions) {
    p.z() = static_cast<float>(0.005 * std::sin(20 * p.x()) * std::cos(25 * p.y()) +
                               0.01 * kSide * random.normal());
  }
  const double width = 2 * kSide;
  const std::vector<Eigen::Vector3f> theirs = bench::pcl_mls(cloud.positions, 1.5 * width);
  if (theirs.empty()) GTEST_SKIP() << "PCL is absent (Debian: libpcl-dev)";
  ASSERT_EQ(theirs.size(), cloud.size());
  const NearPoints points(cloud);
  double worst = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d x = cloud.point(i);
    if (x.head<2>().cwiseAbs().maxCoeff() > kSide * (kHalf - 6)) continue;  // no rim in reach
    const std::optional<MlsFoot> foot = project_mls(points, width, x);
    ASSERT_TRUE(foot);
    worst = std::max(worst, (foot->place - theirs[i].cast<double>()).norm());
  }
  EXPECT_GT(worst, 0);
  EXPECT_LT(worst, 0.02 * kSide);
}

TEST(Rivals, MlsPopsThroughAPlateAtHalfItsThickness) {
  const double thick = 0.02;
  PointCloud plate;
  const Eigen::Vector3f up(0, 0, 1), down(0, 0, -1);
  add_grid(plate, 0, &up);
  add_grid(plate, -thick, &down);
  const std::unique_ptr<Rival> rival = shown("mls", plate);
  const double before = rival->step({0.0011, 0.0007, -0.49 * thick}).force.z();
  const double behind = rival->step({0.0011, 0.0007, -0.51 * thick}).force.z();
  EXPECT_NEAR(before, kStiffness * 0.49 * thick, 1e-3);
  EXPECT_NEAR(behind, -kStiffness * 0.49 * thick, 1e-3);
}

TEST(Rivals, SpheresOnAGridStandBetweenOneAndSevenTenthsOfTheSpacing) {
  const PointCloud cloud = grid();
  const std::unique_ptr<Rival> rival = shown("spheres", cloud);
  for (const auto& [x, height] : {std::pair(0.0, 1.0), std::pair(0.5, std::sqrt(0.5))}) {
    rival->reset({x * kSide, x * kSide, 0.01});
    const Step step = rival->step({x * kSide, x * kSide, -0.003});
    EXPECT_NEAR(step.proxy.z(), height * kSide, 0.05 * kSide) << x;
  }
  rival->reset({-0.03, 0.0003, 0.01});
  double most = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d force = rival->step({-0.03 + 2e-5 * i, 0.0003 + 1e-5 * i, -0.003}).force;
    most = std::max(most, std::atan2(force.head<2>().norm(), force.z()));
  }
  EXPECT_LT(most, 1.05 * std::asin(std::sqrt(0.5)));
}

TEST(Rivals, ABallRollsOverAPlaneAtItsRadius) {
  const PointCloud cloud = grid();
  const std::unique_ptr<Rival> rival = shown("ball", cloud);
  const double radius = 3 * kSide;
  rival->reset({-0.03, 0.0003, 0.02});
  for (int i = 0; i < 1000; ++i) {
    const Step step = rival->step({-0.03 + 5e-5 * i, 0.0003, -0.003});
    if (i < 10) continue;
    EXPECT_LE(step.proxy.z(), 1.001 * radius);
    EXPECT_GE(step.proxy.z(), std::sqrt(radius * radius - kSide * kSide / 2) - 1e-5);
  }
  for (int i = 0; i < 5; ++i) (void)rival->step({0, 0, 0.03});  // it moves by 15 mm in a step
  EXPECT_FALSE(rival->step({0, 0, 0.03}).touching);
}

}  // namespace
}  // namespace palpate::rivals
