// Noise, its map, and the radii that follow from it, on layers whose sigma is known.

#include "prepare/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "palpate/geometry/spacing.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/radii.hpp"
#include "prepare/segment_fit.hpp"
#include "prepare/weights.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr float kSpacing = 0.002f;

// A square sheet of side x side points, curved to z = curvature x^2 / 2, with noise along z that is
// averaged over (2 blur + 1)^2 neighbours and scaled back to `sigma` in the mean.
std::vector<Vector3f> sheet(int side, double sigma, int blur = 0, float curvature = 0) {
  std::mt19937 engine(3);
  std::normal_distribution<float> normal;
  const int wide = side + 2 * blur;
  std::vector<float> white(static_cast<std::size_t>(wide * wide));
  for (float& value : white) value = normal(engine);
  std::vector<Vector3f> points;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      float sum = 0;
      for (int dv = 0; dv <= 2 * blur; ++dv) {
        for (int du = 0; du <= 2 * blur; ++du) {
          sum += white[static_cast<std::size_t>((v + dv) * wide + u + du)];
        }
      }
      const auto x = static_cast<float>(u - side / 2) * kSpacing;
      const float noise = static_cast<float>(sigma) * sum / static_cast<float>(2 * blur + 1);
      points.emplace_back(x, static_cast<float>(v - side / 2) * kSpacing,
                          0.5f * curvature * x * x + noise);
    }
  }
  return points;
}

TEST(SegmentFit, SeesNoNoiseInACurvedSurface) {
  const CellGrid grid(sheet(40, 0, 0, 15));
  SegmentFitter fitter;
  const SegmentFit fit = fitter.fit(grid, Vector3f::Zero(), 0.012, kSpacing);
  EXPECT_NEAR(fit.footprint, kSpacing, 0.1 * kSpacing);
  EXPECT_LT(fit.quadric_residual, 1e-5);
}

TEST(SegmentFit, IsOfOneFaceOfAPlate) {
  for (const float thickness : {0.6f, 1.0f, 3.0f}) {
    std::vector<Vector3f> points = sheet(40, 0);
    for (std::size_t i = 0, count = points.size(); i < count; ++i) {
      points.push_back(points[i] + Vector3f(0.3f, 0.4f, -thickness) * kSpacing);
    }
    SegmentFitter fitter;
    const SegmentFit fit =
        fitter.fit(CellGrid(points), Vector3f::Zero(), 3 * static_cast<double>(kSpacing), kSpacing);
    EXPECT_GT(std::abs(fit.normal.z()), 0.9999) << thickness;
    EXPECT_LT(fit.residual, 1e-6) << thickness;
    EXPECT_EQ(fit.planarity, 1) << thickness;
  }
}

TEST(SegmentFit, MeasuresWhiteNoiseWithoutBias) {
  const CellGrid grid(sheet(80, 0.001));
  SegmentFitter fitter;
  double variance = 0;
  double shared = 0;
  for (int i = 0; i < 49; ++i) {
    const Vector3f at(0.015f * static_cast<float>(i % 7 - 3),
                      0.015f * static_cast<float>(i / 7 - 3), 0);
    const SegmentFit fit = fitter.fit(grid, at, 0.03, kSpacing);
    variance += fit.quadric_residual * fit.quadric_residual / 49;
    shared +=
        fitter.tile_variance(0.03, 0.008) / (fit.quadric_residual * fit.quadric_residual) / 49;
  }
  EXPECT_NEAR(std::sqrt(variance), 0.001, 5e-5);
  EXPECT_NEAR(shared, 1, 0.2);
}

TEST(SegmentFit, LooksAtAScanThatAnOutlierSeesAsAWholeByASample) {
  const CellGrid grid(sheet(300, 0));
  SegmentFitter fitter;
  const SegmentFit fit = fitter.fit(grid, Vector3f(0, 0, 1), 3, 0.5);
  EXPECT_LE(fit.points, SegmentFitter::kMostPoints);
  EXPECT_GT(fit.points, SegmentFitter::kMostPoints / 2);
  EXPECT_NEAR(fit.off, 1, 1e-6);
}

TEST(SegmentFit, StaysFiniteOnDegeneratePoints) {
  SegmentFitter fitter;
  const std::vector<Vector3f> same(30, Vector3f(1, 2, 3));
  const SegmentFit point = fitter.fit(CellGrid(same), Vector3f(1, 2, 3), 0.1, 0.01, 0.02);
  EXPECT_EQ(point.quadric_residual, 0);
  std::vector<Vector3f> line;
  for (int i = 0; i < 30; ++i) line.emplace_back(0.01f * static_cast<float>(i), 0, 0);
  const SegmentFit fit = fitter.fit(CellGrid(line), Vector3f(0.15f, 0, 0), 0.2, 0.01, 0.02);
  EXPECT_TRUE(std::isfinite(fit.quadric_residual) &&
              std::isfinite(fitter.tile_variance(0.2, 0.02)));
  EXPECT_LT(fit.quadric_residual, 1e-6);
  EXPECT_EQ(fitter.fit(CellGrid(line), Vector3f(9, 9, 9), 0.2, 0.01).points, 0u);
}

Noise noise_of(const std::vector<Vector3f>& points, double spacing) {
  const std::vector<float> spacings(points.size(), static_cast<float>(spacing));
  return measure_noise(CellGrid(points), spacing, spacings);
}

TEST(Noise, IsItsDeviationWhereNeighboursErrIndependently) {
  const Noise noise = noise_of(sheet(150, 0.0008), 0.002);
  EXPECT_NEAR(noise.sigma, 0.0008, 5e-5);
  EXPECT_EQ(noise.excess, 1);
}

TEST(Noise, IsKnownToBeSharedWhereNeighboursErrTogether) {
  const Noise noise = noise_of(sheet(150, 0.0008, 2), 0.002);
  EXPECT_NEAR(noise.sigma, 0.0008, 0.00012);  // narrow windows alone see half of it
  EXPECT_GT(noise.excess, 2.5);
}

TEST(Noise, IsNotSeenInAShape) {
  // Waves of 60 mm: far from a quadratic in wide windows, close to one in narrow ones.
  std::vector<Vector3f> waves = sheet(150, 0);
  for (Vector3f& p : waves) p.z() = 0.004f * std::sin(105 * p.x()) * std::cos(105 * p.y());
  const Noise noise = noise_of(waves, 0.002);
  EXPECT_EQ(noise.excess, 1);
  EXPECT_LT(noise.sigma, 5e-5);
}

TEST(Noise, IsMeasuredWhereItFillsALayerManySpacingsThick) {
  for (const double spacings : {1.5, 3., 6.}) {
    const std::vector<Vector3f> layer = sheet(150, spacings * kSpacing);
    const double spacing = median(local_spacings(CellGrid(layer)));
    EXPECT_NEAR(noise_of(layer, spacing).sigma, spacings * kSpacing, 0.1 * spacings * kSpacing);
  }
}

// The rings of a lidar on a road: the farther away, the wider apart. Those of one ring alone fit
// the plane that holds it and its noise.
TEST(Noise, IsMeasuredFromRingToRing) {
  for (const double sigma : {0.002, 0.02}) {
    for (const double step : {0.005, 0.01, 0.02}) {
      std::mt19937 engine(7);
      std::normal_distribution<double> normal(0, sigma);
      PointCloud cloud;
      for (double elevation = -0.4; elevation < -0.06; elevation += step) {
        for (double azimuth = -0.4; azimuth < 0.4; azimuth += 0.004) {
          const double range = 1.7 / std::tan(-elevation);
          cloud.positions.push_back(
              Eigen::Vector3d(range * std::cos(azimuth), range * std::sin(azimuth), normal(engine))
                  .cast<float>());
        }
      }
      const double measured = prepare(cloud).report.noise / sigma;
      EXPECT_GT(measured, 0.5) << sigma << ' ' << step;
      EXPECT_LT(measured, 2) << sigma << ' ' << step;
    }
  }
}

TEST(NoiseMap, TellsNoisyPlacesFromQuietOnes) {
  std::vector<Vector3f> points = sheet(150, 0.001);
  for (Vector3f& p : points) {
    if (p.x() < 0) p.z() *= 0.25f;
  }
  const CellGrid grid(points);
  const NoiseMap map(grid, local_spacings(grid));
  const std::vector<Vector3f> places = {{-0.08f, 0, 0}, {0.08f, 0, 0}, {5, 5, 5}};
  const LocalNoise found = map.at(places, {});
  EXPECT_NEAR(found.products[0], 0.25e-3 * 2e-3, 0.08e-6);
  EXPECT_NEAR(found.products[1], 1e-3 * 2e-3, 0.3e-6);
  EXPECT_GT(found.products[2], 0);  // where nothing is known, what is typical
  EXPECT_NEAR(found.sigmas[0], 0.25e-3, 0.04e-3);
  EXPECT_NEAR(found.sigmas[1], 1e-3, 0.1e-3);
  const LocalNoise shared = map.at(places, {.excess = 3, .shared = 2});
  EXPECT_FLOAT_EQ(shared.products[1], 3 * found.products[1]);
  EXPECT_FLOAT_EQ(shared.sigmas[1], 2 * found.sigmas[1]);
}

TEST(NoiseMap, TellsALayerThatIsThickerThanItsWindowsBesideAThinOne) {
  std::vector<Vector3f> points = sheet(150, 5 * kSpacing);
  for (Vector3f& p : points) {
    if (p.x() < 0) p.z() *= 0.1f;
  }
  const CellGrid grid(points);
  const LocalNoise found = NoiseMap(grid, local_spacings(grid))
                               .at(std::vector<Vector3f>{{-0.1f, 0, 0}, {0.1f, 0, 0}}, {});
  EXPECT_NEAR(found.sigmas[0], 0.5f * kSpacing, 0.1f * kSpacing);
  EXPECT_NEAR(found.sigmas[1], 5 * kSpacing, 0.7f * kSpacing);
}

TEST(NoiseMap, IsNotBiasedWhereNoiseFillsSomeWindowsAndOthersNot) {
  for (const float sigma : {2.5f, 3.5f, 4.5f}) {
    const CellGrid grid(sheet(150, static_cast<double>(sigma * kSpacing)));
    const LocalNoise found =
        NoiseMap(grid, local_spacings(grid)).at(std::vector<Vector3f>(1, Vector3f::Zero()), {});
    EXPECT_NEAR(found.sigmas[0] / kSpacing, sigma, 0.16f * sigma);
  }
}

TEST(NoisyRadii, AreAtLeastFourSigma) {
  const CellGrid grid(sheet(60, 3 * kSpacing));
  const LocalNoise noise{std::vector<float>(grid.size(), 3 * kSpacing),
                         std::vector<float>(grid.size(), 3 * kSpacing * kSpacing)};
  const std::vector<float> floors(grid.size(), 5 * kSpacing);  // as voxels of two spacings have
  const std::vector<float> radii = noisy_radii(grid, noise, 0.3, floors);
  ASSERT_EQ(radii.size(), grid.size());
  for (const float r : radii) EXPECT_GE(r, 11.99f * kSpacing);
}

TEST(NoisyRadii, AreTheRootOfNoiseOverTheWantedError) {
  const CellGrid grid(sheet(60, 0));
  const float product = 0.02f / 3.2f * 5e-5f;  // theta / 3.2 of R^2
  const LocalNoise noise{std::vector<float>(grid.size(), 0.f),
                         std::vector<float>(grid.size(), product)};
  const auto expect_all = [&](float floor, float radius) {
    const std::vector<float> floors(grid.size(), floor);
    const std::vector<float> radii = noisy_radii(grid, noise, 0.02, floors);
    ASSERT_EQ(radii.size(), grid.size());
    for (const float r : radii) EXPECT_NEAR(r, radius, 1e-6f) << floor;
  };
  expect_all(5e-3f, std::sqrt(5e-5f));
  expect_all(2e-3f, 4.8e-3f);  // at most 2.4 times what it would be without noise
}

TEST(NoisyRadii, ShrinkAtAnEdgeAndKeepTheirFloor) {
  std::vector<Vector3f> points;
  for (const Vector3f& p : sheet(60, 0)) {
    points.push_back(p.x() <= 0 ? p : Vector3f(0, p.y(), -p.x()));  // bent down by a right angle
  }
  const CellGrid grid(points);
  std::vector<float> radii(grid.size(), 0.012f);
  shrink_at_edges(grid, std::vector<float>(grid.size(), 0.0095f), radii);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const float from_edge = std::max(-grid.points()[i].x(), -grid.points()[i].z());
    if (std::abs(grid.points()[i].y()) > 0.04f) continue;  // the sheet's own end
    if (from_edge > 0.02f) {
      EXPECT_FLOAT_EQ(radii[i], 0.012f);
    }
    if (from_edge < 0.002f) {
      EXPECT_LT(radii[i], 0.0105f);
    }
    EXPECT_GE(radii[i], 0.0095f);
  }
}

TEST(CountWeights, KeepTheSumOfWeights) {
  const CellGrid grid(sheet(30, 0));
  std::vector<std::uint32_t> counts(grid.size());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = 2 + i % 5;
  const std::vector<float> radii(grid.size(), 0.01f);
  std::vector<float> weights(grid.size(), 1.0f);
  weigh_by_counts(detail::NeighborhoodGraph(grid, radii), counts, radii, weights);
  const float sum = std::accumulate(weights.begin(), weights.end(), 0.0f);
  EXPECT_NEAR(sum / static_cast<float>(weights.size()), 1, 0.05);
  EXPECT_GT(weights[4], 2 * weights[0]);
}

}  // namespace
}  // namespace palpate
