// Compares radii and weights of depth frames with sums over all points.
#include "stream/block_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/cpu.hpp"
#include "field/formulas.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "prepare/weights.hpp"
#include "stream/simd/rims.hpp"
#include "support/depth_frames.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

FilteredDepth depth_of(const test::DepthOf& surface) {
  DepthFilter filter({.noise = NoiseModel{{5e-4, 0, 0}, 1}});
  return filter.filter(test::frame_of(test::small_camera(), 0, surface),
                       Eigen::Isometry3d::Identity());
}

// The weights that a search for neighbours would give.
std::vector<float> searched_weights(const FilteredDepth& depth, const BlockSurface& surface,
                                    std::vector<std::size_t>& blocks) {
  std::vector<Eigen::Vector3f> positions;
  for (std::size_t b = 0; b < depth.size(); ++b) {
    if (depth.states[b] == FilteredDepth::State::empty) continue;
    positions.push_back(depth.positions[b]);
    blocks.push_back(b);
  }
  const CellGrid grid(positions);
  std::vector<float> radii;
  for (const std::uint32_t i : grid.order()) radii.push_back(surface.radius(blocks[i]));
  const std::vector<float> sorted =
      density_weights(WeightSums(detail::NeighborhoodGraph(grid, radii, radii), radii));
  std::vector<float> weights(positions.size());
  for (std::size_t k = 0; k < weights.size(); ++k) weights[grid.order()[k]] = sorted[k];
  return weights;
}

float weight_of(const BlockSurface& surface, std::size_t block) {
  return surface.area(block) / (surface.radius(block) * surface.radius(block));
}

void expect_weights(const test::DepthOf& surface_depth, float tolerance,
                    double minimum_radius = 0) {
  const FilteredDepth depth = depth_of(surface_depth);
  BlockSurface surface(Kernel::wyvill, minimum_radius);
  surface.measure(depth);
  std::vector<std::size_t> blocks;
  const std::vector<float> expected = searched_weights(depth, surface, blocks);
  ASSERT_GT(blocks.size(), 1000u);
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    EXPECT_NEAR(weight_of(surface, blocks[k]) / expected[k], 1, tolerance)
        << "column " << blocks[k] % static_cast<std::size_t>(depth.columns) << ", row "
        << blocks[k] / static_cast<std::size_t>(depth.columns);
  }
}

TEST(BlockSurface, WeighsAWallAsASearchWould) {
  expect_weights(test::wall(0.5), 0.06f);
}

TEST(BlockSurface, WeighsASlopeAsASearchWould) {
  expect_weights(test::plane_depth({0, 0, 0.5}, Vector3d(0.8, 0, -1).normalized()), 0.12f);
}

TEST(BlockSurface, WeighsRimsAndHolesAsASearchWould) {
  expect_weights(
      [](double x, double y) {
        if (std::hypot(x - 0.1, y) < 0.03) return 0.0;
        return x < 0.05 ? 0.4 : 0.5;  // the wall is not seen again, so it ends
      },
      0.12f);
}

// R = 2.5 s for a surface that faces the camera; 2.2 rows of one that does not.
TEST(BlockSurface, RadiiFollowTheSpacingOfRows) {
  const double pitch = 2 / 375.0;
  const FilteredDepth wall = depth_of(test::wall(0.5));
  BlockSurface surface(Kernel::wyvill);
  surface.measure(wall);
  const auto middle = static_cast<std::size_t>(wall.columns * 30 + 40);
  EXPECT_NEAR(surface.radius(middle), 2.5 * pitch * 0.5, 1e-4);
  const double tilt = 70 * std::numbers::pi / 180;
  const FilteredDepth slope =
      depth_of(test::plane_depth({0, 0, 0.5}, Vector3d(std::sin(tilt), 0, -std::cos(tilt))));
  surface.measure(slope);
  const double rows = pitch * 0.5 / std::cos(tilt);
  EXPECT_NEAR(surface.radius(middle) / (2.2 * rows), 1, 0.1);
}

// One frame under waves of noise: R holds its layer, or half a wave. Averaged, it needs neither.
TEST(BlockSurface, SupportHoldsALayerOfNoiseOrHalfAWave) {
  const double pitch = 2 / 375.0;
  const double correlation = 10;
  const double rows = pitch * 0.5;
  FilteredDepth wall = depth_of(test::wall(0.5));
  wall.noise.correlation = correlation;
  BlockSurface surface(Kernel::wyvill);
  const auto middle = static_cast<std::size_t>(wall.columns * 30 + 40);
  const auto radius_at = [&](float deviation) {
    std::fill(wall.deviations.begin(), wall.deviations.end(), deviation);
    surface.measure(wall);
    return surface.radius(middle);
  };
  EXPECT_NEAR(radius_at(8e-3f), correlation * std::sqrt(2 * std::numbers::pi) / 4 * rows, 1e-4);
  const float between = 2.5e-3f;
  EXPECT_NEAR(radius_at(between), 4 * between, 1e-4);
  EXPECT_NEAR(radius_at(2e-4f), 2.5 * rows, 1e-4);
}

TEST(BlockSurface, NoRadiusIsBelowTheMinimum) {
  const FilteredDepth depth =
      depth_of([](double x, double) { return x < 0 ? 0.5 : 0.5 / (1 - 2.5 * x); });
  BlockSurface plain(Kernel::wyvill);
  BlockSurface wide(Kernel::wyvill, 9e-3);
  plain.measure(depth);
  wide.measure(depth);
  bool larger = false;
  for (std::size_t b = 0; b < depth.size(); ++b) {
    if (depth.states[b] == FilteredDepth::State::empty) continue;
    EXPECT_GE(wide.radius(b), 9e-3f);
    EXPECT_GE(wide.radius(b), plain.radius(b));
    larger = larger || wide.radius(b) > 9.01e-3f;
  }
  EXPECT_TRUE(larger) << "where points are farther apart";
}

TEST(BlockSurface, WideRadiiWeighAsASearchWould) {
  expect_weights(test::wall(0.5), 0.06f, 15e-3);
  expect_weights(test::wall(0.5), 0.06f, 35e-3);
}

TEST(BlockSurface, RadiiGrowByHalfTheDistanceAtMost) {
  const FilteredDepth depth =
      depth_of([](double x, double) { return x < 0 ? 0.5 : 0.5 / (1 - 2.5 * x); });
  BlockSurface surface(Kernel::wyvill);
  surface.measure(depth);
  int pairs = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 1; u < depth.columns; ++u) {
      const auto b = static_cast<std::size_t>(v * depth.columns + u);
      if (depth.states[b] == FilteredDepth::State::empty ||
          depth.states[b - 1] == FilteredDepth::State::empty) {
        continue;
      }
      const float way = (depth.positions[b] - depth.positions[b - 1]).norm();
      EXPECT_LE(surface.radius(b) - surface.radius(b - 1), 0.5f * way + 2e-3f * way + 1.4e-3f);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 1000);
}

TEST(BlockSurface, TrustsAPointByItsPrecisionAmongThoseAround) {
  FilteredDepth depth = depth_of(test::wall(0.5));
  const auto uncertain = static_cast<std::size_t>(depth.columns * 30 + 41);
  depth.deviations[uncertain] = 2e-3f;
  BlockSurface surface(Kernel::wyvill);
  surface.measure(depth);
  const auto precision = [&](std::size_t b) {
    return 1 / (std::pow(depth.deviations[b], 2) + std::pow(0.157f * surface.radius(b), 2));
  };
  for (const std::size_t b : {uncertain - 1, uncertain, std::size_t{0}, depth.size() - 1}) {
    double sum = 0;
    double count = -1;  // not the block itself
    for (std::size_t other = 0; other < depth.size(); ++other) {
      const auto columns = static_cast<std::ptrdiff_t>(depth.columns);
      const auto way = static_cast<std::ptrdiff_t>(other) - static_cast<std::ptrdiff_t>(b);
      const std::ptrdiff_t u =
          static_cast<std::ptrdiff_t>(other) % columns - static_cast<std::ptrdiff_t>(b) % columns;
      if (std::abs(u) > 1 || std::abs((way - u) / columns) > 1) continue;
      ++count;
      if (other != b) sum += precision(other);
    }
    EXPECT_NEAR(surface.trust(b), std::min(1.0, precision(b) * count / sum), 1e-4) << b;
  }
}

TEST(BlockSurface, OutsideOfReachRimsWeighAsIfTheSurfaceWentOn) {
  const FilteredDepth depth = depth_of(test::wall(0.5));
  BlockSurface exact(Kernel::wyvill);
  BlockSurface local(Kernel::wyvill);
  exact.measure(depth);
  const std::vector<Ball> reach{{depth.positions[0].cast<double>(), 0.03}};
  local.measure(depth, reach);
  const std::size_t last = depth.size() - 1;
  EXPECT_EQ(local.area(0), exact.area(0));
  EXPECT_LT(local.area(last), 0.8f * exact.area(last));
}

// Sums over windows around eight blocks of a bent sheet, as both levels of the instruction set give
// them, beside sums one by one.
void expect_sums_around(Kernel kernel) {
  constexpr int kReach = 4;
  constexpr int kStride = 2 * kReach + simd::kRimLanes;
  constexpr float kRadius = 0.035F;
  std::vector<float> x, y, z, per_r2, factors;
  for (int k = 0; k < kStride * (2 * kReach + 1); ++k) {
    x.push_back(0.01F * static_cast<float>(k % kStride));
    y.push_back(0.01F * static_cast<float>(k / kStride));
    z.push_back(40 * x.back() * x.back() * y.back());
    per_r2.push_back(1 / (kRadius * kRadius));
    factors.push_back(1 + 0.1F * static_cast<float>(k % 7));
  }
  const int at = kReach * kStride + kReach;
  per_r2[at + 2] = PaddedBlocks::kNowhere;
  const std::int32_t halves[simd::kRimLanes] = {4, 3, 2, 1, 0, 4, 4, 2};
  const auto sums_of = [&](const simd::RimFunctions& functions) {
    std::vector<float> sums(simd::kRimLanes);
    functions.around({&x[at], &y[at], &z[at], &per_r2[at], &factors[at], kStride},
                     kernel == Kernel::wendland, halves, sums.data());
    return sums;
  };
  const std::vector<float> sums = sums_of(simd::kRimsBaseline);
  for (int l = 0; l < simd::kRimLanes; ++l) {
    double expected = 0;
    for (int v = -halves[l]; v <= halves[l]; ++v) {
      for (int u = -halves[l]; u <= halves[l]; ++u) {
        const int from = at + l + v * kStride + u;
        const double far =
            std::hypot(x[from] - x[at + l], y[from] - y[at + l], z[from] - z[at + l]);
        const double q = far * far * double{per_r2[from]};
        if (q < 1) expected += evaluate(kernel, q).w * double{factors[from]};
      }
    }
    EXPECT_NEAR(sums[l], expected, 1e-5 * expected) << "block " << l;
  }
  if (cpu_has_v3()) {
    EXPECT_EQ(sums_of(simd::kRimsV3), sums);
  }
}

TEST(BlockSurface, SumsAroundRimsAreTheSameBitsOnOlderProcessors) {
  expect_sums_around(Kernel::wyvill);
  expect_sums_around(Kernel::wendland);
}

}  // namespace
}  // namespace palpate
