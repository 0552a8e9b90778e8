#include "field/facing.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "field/patch.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A plane at the height z as preparation makes it, m: one sheet, whose normals point this way.
std::unique_ptr<SurfacePoints> sheet_at(double z, double sign) {
  std::vector<test::TestPoint> plane;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      plane.push_back({{2e-3 * i, 2e-3 * j, z}, sign * Vector3d::UnitZ(), 5e-3, 1});
    }
  }
  auto points = std::make_unique<SurfacePoints>(test::make_points(plane));
  const float infinity = std::numeric_limits<float>::infinity();
  points->sheets = {.sheet = std::vector<std::uint32_t>(points->size(), 0),
                    .part = {0},
                    .known = {0},
                    .residual = std::vector<float>(points->size(), 0),
                    .above = std::vector<float>(points->size(), infinity),
                    .below = std::vector<float>(points->size(), infinity)};
  return points;
}

TEST(Facing, ASurfaceThatRisesFromCloudToCloudKeepsItsSide) {
  Patch patch(2048);
  std::vector<std::unique_ptr<SurfacePoints>> clouds;
  for (int k = 0; k < 60; ++k) {
    const double z = 0.5e-3 * k;  // a tenth of R a cloud
    clouds.push_back(sheet_at(z, k % 2 == 0 ? 1 : -1));
    // Free and above the first; on all that follow.
    const Stance stance{{0, 0, k == 0 ? 4e-3 : z}, {0, 0, k == 0 ? 0. : 1.}};
    patch.gather(std::vector<ActiveLayer>{{.points = clouds.back().get()}}, 1, {0, 0, z}, 2e-3,
                 {.stance = &stance});
    ASSERT_GT(patch.points(), 20u);
    for (std::uint32_t i = 0; i < patch.columns().end(); ++i) {
      ASSERT_GE(patch.columns().normal[2][i], 0) << k;  // 0: a point that fills a run up
    }
  }
}

}  // namespace
}  // namespace palpate
