#include "depth/blocks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "depth/small_frames.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
const NoiseModel kMillimetre{{1e-3, 0, 0}, 1};

/// The one block of these four pixels: upper row, lower row.
depth::Blocks one_block(const std::array<float, 4>& pixels) {
  depth::Blocks blocks;
  blocks.resize(depth::block_grid({2, 2, {525, 525, 0.5, 0.5}, {}}));
  depth::average_blocks(pixels.data(), 2, kMillimetre, {}, blocks);
  return blocks;
}
float depth_of(const std::array<float, 4>& pixels) {
  const depth::Blocks blocks = one_block(pixels);
  const float rho = blocks.rho[blocks.at(0, 0)];
  return rho > 0 ? 1 / rho : 0;
}
int count_of(const std::array<float, 4>& pixels) {
  const depth::Blocks blocks = one_block(pixels);
  return blocks.counts[blocks.at(0, 0)];
}

TEST(Blocks, AverageFourPixels) {
  EXPECT_NEAR(depth_of({1.0F, 1.001F, 0.999F, 1.002F}), 1.0005F, 1e-6F);
  EXPECT_EQ(count_of({1.0F, 1.001F, 0.999F, 1.002F}), 4);
}

TEST(Blocks, LeaveOutWhatFliesAndWhatIsNotMeasured) {
  EXPECT_NEAR(depth_of({1.0F, 1.001F, 1.2F, 0.999F}), 1.0F, 1e-6F);
  EXPECT_EQ(count_of({1.0F, 1.001F, 1.2F, 0.999F}), 3);
  for (const float hole : {0.0F, -1.0F, kNan, kInfinity, -kInfinity, 0.05F, 25.0F}) {
    EXPECT_NEAR(depth_of({1.0F, hole, 1.001F, 0.999F}), 1.0F, 1e-6F) << hole;
    EXPECT_EQ(count_of({hole, 1.0F, hole, hole}), 1) << hole;
    EXPECT_EQ(count_of({hole, hole, hole, hole}), 0) << hole;
    EXPECT_EQ(depth_of({hole, hole, hole, hole}), 0) << hole;
  }
}

TEST(Blocks, AreEmptyHalfwayBetweenTwoSurfaces) {
  EXPECT_EQ(count_of({1.0F, 1.2F, 1.0F, 1.2F}), 0);
  EXPECT_EQ(depth_of({1.0F, 1.2F, 1.0F, 1.2F}), 0);
  EXPECT_EQ(count_of({1.0F, 0, 1.2F, 0}), 0);
}

TEST(Blocks, TakeNoOddRowOrColumn) {
  const depth::BlockGrid grid = depth::block_grid({7, 5, {525, 525, 3, 2}, {}});
  EXPECT_EQ(grid.columns, 3);
  EXPECT_EQ(grid.rows, 2);
  EXPECT_DOUBLE_EQ(grid.x(1), (2.5 - 3) / 525);
}

TEST(Flying, BlocksBetweenSurfacesAreNoPoints) {
  const NoiseModel noise = kinect_like_noise();
  const std::vector<Solid> solids = {sphere({0, 0, 0.6}, 0.04), plane({0, 0, 0.9}, {0, 0, -1})};
  int points = 0;
  int astray = 0;
  for (std::uint64_t number = 0; number < 4; ++number) {
    const DepthFrame frame = noisy_frame(solids, {.silhouettes = true}, number);
    const depth::Blocks blocks = blocks_of(frame, noise);
    for (int row = 0; row < blocks.grid.rows; ++row) {
      for (int column = 0; column < blocks.grid.columns; ++column) {
        const float rho = blocks.rho[blocks.at(column, row)];
        if (!(rho > 0)) continue;
        const Vector3d p = Vector3d(blocks.grid.x(column), blocks.grid.y(row), 1) / rho;
        const bool near =
            std::abs(distance(solids[0], p)) < 0.02 || std::abs(distance(solids[1], p)) < 0.02;
        ++points;
        if (!near) ++astray;
      }
    }
  }
  EXPECT_GT(points, 4 * 4800 * 0.97);
  EXPECT_LE(astray, 4);  // two flying neighbours may agree by chance
}

TEST(Flying, SurfacesSeenAtEightyTwoDegreesStay) {
  const NoiseModel noise = kinect_like_noise();
  const Vector3d ray = Vector3d(0, 0.1, 0.8).normalized();
  const Vector3d normal = Eigen::AngleAxisd(-1.43, Vector3d::UnitX()) * -ray;
  const DepthFrame floor = noisy_frame({plane({0, 0.1, 0.8}, normal)}, {});
  int measured = 0;
  int left = 0;
  const depth::Blocks blocks = blocks_of(floor, noise);
  for (int row = 0; row < blocks.grid.rows; ++row) {
    for (int column = 0; column < blocks.grid.columns; ++column) {
      const float z = floor.depth[static_cast<std::size_t>(2 * row * 160 + 2 * column)];
      if (!(z > 0.3F && z < 1.2F)) continue;
      ++measured;
      left += blocks.rho[blocks.at(column, row)] > 0 ? 1 : 0;
    }
  }
  ASSERT_GT(measured, 500);
  EXPECT_GT(left, 0.9 * measured);
}

TEST(PlainFits, AreExactOnPlanes) {
  const Vector3d normal = Vector3d(0.3, -0.5, -0.8).normalized();
  const NoiseModel fine{{1e-5, 0, 0}, 1};
  const depth::Blocks blocks = blocks_of(exact_frame({plane({0, 0, 0.7}, normal)}), fine);
  depth::BlockFits fits;
  fits.resize(blocks.grid);
  depth::for_rows(blocks.grid, [&](int row) {
    depth::fit_plain(blocks, fine, row, 0, blocks.grid.columns, fits);
  });
  const Vector3d exact = normal / normal.dot(Vector3d(0, 0, 0.7));
  for (std::size_t i = 0; i < fits.size(); ++i) {
    ASSERT_EQ(fits.states[i], FilteredDepth::State::plain);
    EXPECT_NEAR(fits.slope_x[i], exact.x(), 5e-3);
    EXPECT_NEAR(fits.slope_y[i], exact.y(), 5e-3);
    EXPECT_GT(fits.confidences[i], 0);
  }
}

TEST(PlainFits, HaveNoNormalWhereNothingIsNear) {
  DepthFrame frame = exact_frame({}, kSmall);
  for (int u = 40; u < 90; ++u) {
    frame.depth[static_cast<std::size_t>(30 * 160 + u)] = 0.8F;
    frame.depth[static_cast<std::size_t>(31 * 160 + u)] = 0.8F;
  }
  const depth::Blocks blocks = blocks_of(frame, kMillimetre);
  depth::BlockFits fits;
  fits.resize(blocks.grid);
  depth::for_rows(blocks.grid, [&](int row) {
    depth::fit_plain(blocks, kMillimetre, row, 0, blocks.grid.columns, fits);
  });
  const std::size_t middle = blocks.grid.index(30, 15);
  EXPECT_EQ(fits.states[middle], FilteredDepth::State::plain);
  EXPECT_EQ(fits.confidences[middle], 0);
  EXPECT_EQ(fits.slope_x[middle], 0);
}

/// Blocks of depth 1 m in one row, with a gap, and `after` behind it.
depth::Blocks row_with_gap(int gap, float after) {
  depth::Blocks blocks;
  blocks.resize(depth::block_grid({64, 2, {525, 525, 31.5, 0.5}, {}}));
  for (int column = 0; column < 32; ++column) {
    if (column >= 10 && column < 10 + gap) continue;
    blocks.rho[blocks.at(column, 0)] = column < 10 ? 1 : 1 / after;
    blocks.counts[blocks.at(column, 0)] = 4;
  }
  return blocks;
}

TEST(FillGaps, BridgesWhatIsShortAndOfOneSurface) {
  depth::Blocks filled;
  const auto fill = [&](int gap, float after) {
    const depth::Blocks blocks = row_with_gap(gap, after);
    depth::fill_gaps(blocks, kMillimetre, {0, 0, 32, 1}, filled);
    return filled.rho[filled.at(10, 0)];
  };
  EXPECT_NEAR(fill(3, 1.004F), 1 + 0.25F * (1 / 1.004F - 1), 1e-6F);
  EXPECT_EQ(filled.counts[filled.at(11, 0)], 0);
  EXPECT_EQ(filled.counts[filled.at(13, 0)], 4);
  EXPECT_EQ(fill(4, 1.0F), 0);
  EXPECT_EQ(fill(2, 1.3F), 0);
}

// Orthonormal polynomial of degree 0, 1, 2 over `side` places.
std::vector<double> polynomial(int degree, int side) {
  std::vector<double> values;
  double squares = 0;
  for (int i = 0; i < side; ++i) {
    const double x = i - (side - 1) / 2.0;
    const double mu = (side * side - 1) / 12.0;
    values.push_back(degree == 0 ? 1 : degree == 1 ? x : x * x - mu);
    squares += values.back() * values.back();
  }
  for (double& value : values) value /= std::sqrt(squares);
  return values;
}

// Variance of the polynomial's coefficient under Gaussian correlation of this length.
double variance_of(const std::vector<double>& p, double length) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < p.size(); ++j) {
      const double d = static_cast<double>(i) - static_cast<double>(j);
      sum += p[i] * p[j] * std::exp(-d * d / (2 * length * length));
    }
  }
  return sum;
}

// The same of windows that the correlation reaches across and of those that it does not.
TEST(Blocks, SharedErrorOfATermIsWhatCorrelationLeavesOfIt) {
  for (const double length : {2.0, 3.0, 4.0}) {                     // blocks
    const double c = 2 * length * std::sqrt(2 * std::numbers::pi);  // its square counts pixels
    for (const int side : {9, 13, 21, 41}) {
      if (length > side / 4.5) continue;
      SCOPED_TRACE(side / length);
      const double mean = variance_of(polynomial(0, side), length);
      const double slope = variance_of(polynomial(1, side), length);
      const double bend = variance_of(polynomial(2, side), length);
      const double blocks = side * side;
      EXPECT_NEAR(depth::shared_error(c, 0, blocks) / (mean * mean), 1, 0.25);
      EXPECT_NEAR(depth::shared_error(c, 1, blocks) / (mean * slope), 1, 0.25);
      EXPECT_NEAR(depth::shared_error(c, 2, blocks) / (mean * bend), 1, 0.35);
    }
  }
  EXPECT_EQ(depth::shared_error(1, 2, 25), 1);
}

}  // namespace
}  // namespace palpate::test
