#include "depth/window_fits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/cpu.hpp"
#include "base/numbers.hpp"
#include "depth/metric_fit.hpp"
#include "depth/simd/fits.hpp"
#include "depth/small_frames.hpp"
#include "depth/window_errors.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

struct Comparison {
  Errors fast;
  Errors slow;
};

/// Every third block that `wanted` picks, by both forms.
template <class Wanted>
Comparison compare(const std::vector<Solid>& solids, const Solid& truth, const NoiseModel& noise,
                   double largest, const Wanted& wanted) {
  Comparison both;
  SimulatedNoiseOptions simulated{.model = noise, .rounding = 0};
  for (std::uint64_t frame = 0; frame < 2; ++frame) {
    const depth::Blocks blocks = blocks_of(noisy_frame(solids, simulated, frame), noise);
    const depth::BlockFits fits = fit_all(blocks, noise);
    const MetricFitter slow(blocks, {noise, largest});
    for (int row = 12; row < blocks.grid.rows - 12; row += 3) {
      for (int column = 12; column < blocks.grid.columns - 12; column += 3) {
        if (!(blocks.rho[blocks.at(column, row)] > 0)) continue;
        const Vector3d position = position_of(fits, column, row);
        if (!wanted(position)) continue;
        const MetricFit other = slow.fit(column, row);
        if (!other.found) continue;
        both.fast.add(truth, position, normal_of(fits, column, row));
        both.slow.add(truth, other.position, other.normal);
      }
    }
  }
  return both;
}

TEST(WindowFits, FindAPlaneAsWellAsTheSlowForm) {
  const Solid table = plane({0, 0, 0.7}, Vector3d(0.1, -0.8, -0.6).normalized());
  const Comparison both =
      compare({table}, table, kinect_like_noise(), 0.022, [](const Vector3d&) { return true; });
  ASSERT_GT(both.fast.count, 200);
  EXPECT_LT(both.fast.rms_angle(), 0.35 * kDegree);
  EXPECT_LT(both.fast.rms_angle(), 1.3 * both.slow.rms_angle());
  EXPECT_LT(both.fast.rms_height(), 0.08e-3);
  EXPECT_LT(both.fast.rms_height(), 1.3 * both.slow.rms_height());
}

// Neighbouring blocks alone would mistake such noise for slopes, and make windows too small.
TEST(WindowFits, FindAPlaneInTheNoiseOfATimeOfFlightCamera) {
  const Solid wall = plane({0, 0, 1.2}, Vector3d(0.1, -0.3, -0.95).normalized());
  const NoiseModel noise{{0, 0, 0.015}, 1};
  const Comparison both =
      compare({wall}, wall, noise, 0.0355, [](const Vector3d&) { return true; });
  ASSERT_GT(both.fast.count, 200);
  EXPECT_LT(both.fast.rms_angle(), 3.1 * kDegree);
  EXPECT_LT(both.fast.rms_height(), 0.8e-3);
  EXPECT_LT(both.fast.rms_angle(), both.slow.rms_angle());  // whose balls leave out what errs most
}

TEST(WindowFits, FindASphereNearlyAsWellAsTheSlowForm) {
  const Solid ball = sphere({0, 0, 0.66}, 0.06);
  const Solid wall = plane({0, 0, 1}, {0, 0, -1});
  const Comparison both =
      compare({ball, wall}, ball, kinect_like_noise(), 0.02, [](const Vector3d& p) {
        return std::hypot(p.x(), p.y()) < 0.06 * std::sin(50 * kDegree) && p.z() < 0.67;
      });
  ASSERT_GT(both.fast.count, 150);
  EXPECT_LT(both.fast.rms_angle(), 2.0 * kDegree);
  EXPECT_LT(both.fast.rms_angle(), 1.4 * both.slow.rms_angle());
  EXPECT_LT(both.fast.rms_height(), 0.25e-3);
}

TEST(WindowFits, ComeCloserToAnEdgeThanTheSlowForm) {
  const Solid block = box({0, 0, 0.75}, 0.07, 40 * kDegree, 20 * kDegree);
  const Comparison both =
      compare({block}, block, kinect_like_noise(), 0.02, [&](const Vector3d& p) {
        const Vector3d local = (block.T_world_solid.inverse() * p).cwiseAbs();
        Vector3d gaps = block.size - local;
        std::sort(gaps.begin(), gaps.end());
        return gaps[1] > 2.5e-3 && gaps[1] < 10e-3;  // from the nearest edge, on a face
      });
  ASSERT_GT(both.fast.count, 60);
  EXPECT_LT(both.fast.rms_angle(), both.slow.rms_angle());
  EXPECT_LT(both.fast.rms_angle(), 4 * kDegree);
}

TEST(WindowFits, AreExactOnAPlaneWithoutNoise) {
  const Vector3d normal = Vector3d(0.2, -0.6, -0.7).normalized();
  const Solid table = plane({0, 0, 0.7}, normal);
  const NoiseModel fine{{1e-5, 0, 0}, 1};
  const depth::Blocks blocks = blocks_of(exact_frame({table}), fine);
  const depth::BlockFits fits = fit_all(blocks, fine);
  for (int row = 0; row < fits.grid.rows; ++row) {
    for (int column = 0; column < fits.grid.columns; ++column) {
      ASSERT_EQ(fits.states[fits.grid.index(column, row)], FilteredDepth::State::fitted);
      EXPECT_NEAR(distance_and_normal(table, position_of(fits, column, row)).value, 0, 5e-6);
      EXPECT_LT((normal_of(fits, column, row) - normal).norm(), 2e-3);
    }
  }
}

TEST(WindowFits, TellTheirOwnErrors) {
  const Solid table = plane({0, 0, 0.7}, Vector3d(0, -0.8, -0.6).normalized());
  const NoiseModel noise = kinect_like_noise();
  double places = 0;
  double slopes = 0;
  double count = 0;
  for (std::uint64_t frame = 0; frame < 6; ++frame) {
    const DepthFrame image = noisy_frame({table}, {.rounding = 0}, frame);
    const depth::BlockFits fits = fit_all(blocks_of(image, noise), noise);
    const Vector3d exact = table.T_world_solid.linear().col(2) /
                           table.T_world_solid.linear().col(2).dot(Vector3d(0, 0, 0.7));
    for (int row = 12; row < fits.grid.rows - 12; row += 4) {
      for (int column = 12; column < fits.grid.columns - 12; column += 4) {
        const std::size_t i = fits.grid.index(column, row);
        const Vector3d ray(fits.grid.x(column), fits.grid.y(row), 1);
        places += std::pow(fits.rho[i] - exact.dot(ray), 2) / fits.variance[i];
        slopes += std::pow(fits.slope_y[i] - exact.y(), 2) / fits.slope_variance[i];
        ++count;
      }
    }
  }
  EXPECT_NEAR(places / count, 1, 0.35);
  EXPECT_NEAR(slopes / count, 1, 0.35);
}

// A small one of many windows around a block often fails by chance where the largest is a plane:
// asked from the smallest on, a tenth of the blocks would be beside an edge.
TEST(WindowFits, TakeNoChanceForAnEdge) {
  const Solid table = plane({0, 0, 0.7}, Vector3d(0, -0.8, -0.6).normalized());
  const NoiseModel noise = kinect_like_noise();
  int edges = 0;
  int count = 0;
  for (std::uint64_t frame = 0; frame < 4; ++frame) {
    const DepthFrame image = noisy_frame({table}, {.rounding = 0}, frame);
    const depth::BlockFits fits = fit_all(blocks_of(image, noise), noise);
    for (int row = 24; row < fits.grid.rows - 24; ++row) {
      for (int column = 24; column < fits.grid.columns - 24; ++column, ++count) {
        edges += fits.reach_u[fits.grid.index(column, row)] > 0;
      }
    }
  }
  EXPECT_LT(edges, count / 15);
}

TEST(WindowFits, GiveTheSameBitsOnOlderProcessors) {
  if (!cpu_has_v3()) GTEST_SKIP() << "this processor has one level of the instruction set only";
  const std::vector<Solid> solids = {sphere({0.03, 0, 0.6}, 0.06),
                                     box({-0.06, 0.02, 0.7}, 0.05, 0.6, 0.4),
                                     plane({0, 0, 0.9}, Vector3d(0, -0.5, -0.8).normalized())};
  const NoiseModel noise = kinect_like_noise();
  const depth::Blocks blocks = blocks_of(noisy_frame(solids, {.silhouettes = true}), noise);
  std::vector<std::vector<float>> columns[2];
  int level = 0;
  for (const simd::FitFunctions* functions : {&simd::kFitsBaseline, &simd::kFitsV3}) {
    const depth::BlockFits fits = fit_all(blocks, noise, *functions);
    columns[level] = {fits.rho,     fits.variance,       fits.slope_x,
                      fits.slope_y, fits.slope_variance, fits.confidences};
    ++level;
  }
  EXPECT_EQ(columns[0], columns[1]);
}

// The other passes over all blocks have a copy for newer processors too.
TEST(PlainFits, GiveTheSameBitsOnOlderProcessors) {
  if (!cpu_has_v3()) GTEST_SKIP() << "this processor has one level of the instruction set only";
  const std::vector<Solid> solids = {sphere({0.03, 0, 0.6}, 0.06), plane({0, 0, 0.9}, {0, 0, -1})};
  CameraModel camera = kSmall;
  camera.width = 154;  // 77 blocks: the last ones are no whole eight
  const DepthFrame frame = noisy_frame(solids, {.silhouettes = true}, 0, camera);
  const simd::DepthGate gate{0.1F, 20, {0.004F, 0.006F, 0.005F}};
  const simd::BlockLimits limits{{0.0008F, -0.0008F, 0.001F}, 4.3F, 0.01F, 7.3F};
  depth::Blocks blocks[2];
  depth::BlockFits fits[2];
  int level = 0;
  for (const simd::PlainFunctions* functions : {&simd::kPlainBaseline, &simd::kPlainV3}) {
    depth::Blocks& b = blocks[level];
    depth::BlockFits& f = fits[level++];
    b.resize(depth::block_grid(camera));
    f.resize(b.grid);
    const auto stride = static_cast<std::ptrdiff_t>(b.stride);
    const auto each_row = [&](auto action) {
      for (int row = 0; row < b.grid.rows; ++row) action(row, b.at(0, row));
    };
    each_row([&](int row, std::size_t at) {
      functions->average(frame.depth.data() + std::ptrdiff_t{2} * row * camera.width, camera.width,
                         b.grid.columns, gate, &b.rho[at], &b.counts[at]);
    });
    const std::vector<float> before = b.rho;
    each_row([&](int, std::size_t at) {
      functions->reject(&before[at], stride, b.grid.columns, limits, 2, &b.rho[at], &b.counts[at]);
    });
    EXPECT_NE(b.rho, before);
    each_row([&](int row, std::size_t at) {
      functions->fit(&b.rho[at], &b.counts[at], stride, b.grid.columns, limits, 262.5F, 262.5F,
                     f.row(row));
    });
  }
  EXPECT_EQ(blocks[0].rho, blocks[1].rho);
  EXPECT_EQ(blocks[0].counts, blocks[1].counts);
  EXPECT_EQ(fits[0].states, fits[1].states);
  EXPECT_EQ(fits[0].variance, fits[1].variance);
  EXPECT_EQ(fits[0].slope_x, fits[1].slope_x);
  EXPECT_EQ(fits[0].slope_y, fits[1].slope_y);
  EXPECT_EQ(fits[0].slope_variance, fits[1].slope_variance);
  EXPECT_EQ(fits[0].confidences, fits[1].confidences);
}

}  // namespace
}  // namespace palpate::test
