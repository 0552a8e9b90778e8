// The support radius of each point by spacing, noise and what is asked for.
#include "prepare/radii.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr double kTypicalSpacing = 2e-3;

/// R of three points a kilometre apart, of 1, 2 and 4 mm spacing.
class SupportRadii : public testing::Test {
 protected:
  SupportRadii() {
    sampling_.grid = CellGrid(std::vector<Vector3f>{{0, 0, 0}, {1000, 0, 0}, {2000, 0, 0}});
    for (const std::uint32_t i : sampling_.grid.order()) {
      sampling_.spacings.push_back(1e-3f * static_cast<float>(1 << i));
    }
    sampling_.spacing = sampling_.facts.spacing = kTypicalSpacing;
    sampling_.facts.extent.extend(Eigen::Vector3d(0, 0, 0));
    sampling_.facts.extent.extend(Eigen::Vector3d(2000, 0, 0));
    options_.remove_speckle = false;
  }

  void expect(std::size_t point, double radius) {
    const std::vector<float> radii = choose_radii(sampling_, options_).values;
    const auto place = std::ranges::find(sampling_.grid.order(), point);
    ASSERT_EQ(radii.size(), 3u);
    EXPECT_NEAR(radii[static_cast<std::size_t>(place - sampling_.grid.order().begin())], radius,
                1e-8);
  }

  Sampling sampling_;
  PrepareOptions options_;
};

TEST_F(SupportRadii, AreTwoAndAHalfSpacings) {
  expect(0, 2.5e-3);
  expect(2, 10e-3);
  options_.smoothing = 1.6;
  expect(1, 8e-3);
  options_.smoothing = 1;
  options_.minimum_radius = 6e-3;
  expect(0, 6e-3);
}

TEST_F(SupportRadii, KeepTheWantedErrorOfNormals) {
  sampling_.facts.noise.sigma = 0.35e-3;
  const double radius = std::sqrt(3.2 * 0.35e-3 * kTypicalSpacing / options_.normal_error);
  expect(1, radius);
  options_.smoothing = 1.1;
  expect(1, 1.1 * radius);
  options_.smoothing = 1;
  sampling_.voxel = kTypicalSpacing;
  sampling_.facts.spacing = 8e-3;
  expect(0, 6e-3);  // six spacings of its own and no more
  sampling_.facts.extent = Box();
  sampling_.facts.extent.extend(Eigen::Vector3d(0, 0, 0));
  sampling_.facts.extent.extend(Eigen::Vector3d(25 * 9e-3, 0, 0));
  expect(1, 9e-3);   // the finest shape
  expect(2, 10e-3);  // its spacing needs more
}

TEST_F(SupportRadii, AreAllAlikeWhereOneIsGiven) {
  options_.radius = 7e-3;
  for (const std::size_t i : {0, 1, 2}) expect(i, 7e-3);
}

}  // namespace
}  // namespace palpate
