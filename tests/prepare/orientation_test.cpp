// Normals whose signs are anything agree afterwards, and face the side that is known to be free.
#include "prepare/orientation.hpp"

#include <gtest/gtest.h>

#include <random>

#include "palpate/io/synthetic.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

/// Points of a synthetic cloud with its normals, the signs of half of which are turned.
struct Turned {
  explicit Turned(const char* name) {
    const PointCloud cloud = synthetic_cloud(name, {.spacing = 4e-3});
    sampling.grid = CellGrid(cloud.positions);
    truth = in_grid_order(sampling.grid, cloud.normals);
    std::mt19937 random(5);
    fits.normals = truth;
    for (Vector3f& normal : fits.normals) {
      if (random() % 2 == 0) normal = -normal;
    }
  }

  /// How many normals point to where the truth does, after orient().
  std::size_t alike(const PriorSigns& prior) {
    orient(sampling, prior, fits);
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) count += fits.normals[i].dot(truth[i]) > 0;
    return count;
  }

  Sampling sampling;
  std::vector<Vector3f> truth;
  PointFits fits;
};

TEST(Orientation, ClosedBodiesPointOutward) {
  for (const char* const name : {"sphere", "torus"}) {
    Turned turned(name);
    EXPECT_EQ(turned.alike({}), turned.truth.size()) << name;
  }
}

TEST(Orientation, GivenNormalsDecideForAllThatHangsTogether) {
  Turned turned("sphere");
  std::vector<Vector3f> given(turned.truth.size(), Vector3f::Zero());
  given[7] = -turned.truth[7];  // one alone, inward
  EXPECT_EQ(turned.alike({given, {}, {}}), 0u);
}

TEST(Orientation, TheEyeDecidesWhereNothingIsGiven) {
  Turned below("bumps");
  EXPECT_EQ(below.alike({{}, Vector3f(0, 0, -1), {}}), 0u);
  Turned above("bumps");
  EXPECT_EQ(above.alike({{}, Vector3f(0, 0, 1), {}}), above.truth.size());
}

TEST(Orientation, PointsWithoutAPlaneStayWithout) {
  Turned turned("sphere");
  turned.fits.normals[3].setZero();
  EXPECT_EQ(turned.alike({}), turned.truth.size() - 1);
  EXPECT_TRUE(turned.fits.normals[3].isZero());
}

}  // namespace
}  // namespace palpate
