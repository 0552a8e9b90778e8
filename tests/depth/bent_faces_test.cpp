// Quadrics through what is bent: what one sees, when there is none, and what they do to blocks.
#include "depth/bent_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "depth/noisy_frames.hpp"
#include "depth/small_frames.hpp"
#include "depth/window_errors.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const Solid kBall = sphere({0, 0, 0.66}, 0.06);
constexpr int kColumn = 30;  // of a block of it that is bent
constexpr int kRow = 24;

// A frame's blocks and fits, as windows leave them and quadrics make them.
struct BentFrame {
  NoiseModel noise;
  depth::Blocks blocks;
  depth::BlockFits fits;

  BentFrame(const DepthFrame& frame, const NoiseModel& model)
      : noise(model), blocks(blocks_of(frame, model)), fits(fit_all(blocks, model)) {}

  [[nodiscard]] simd::FitInput input() const {
    simd::FitInput in{};
    in.table.columns = blocks.grid.columns;
    in.table.rows = blocks.grid.rows;
    in.blocks = {&blocks.rho[blocks.at(0, 0)], &blocks.counts[blocks.at(0, 0)],
                 static_cast<std::ptrdiff_t>(blocks.stride)};
    return in;
  }
  [[nodiscard]] std::optional<depth::Quadric> quadric(int column, int row) const {
    return fit_quadric(input(), noise, fits, column, row);
  }
};

NoiseModel blurred_noise() {
  NoiseModel noise = kinect_like_noise();
  noise.correlation = kBlurred;
  return noise;
}

// Errors of what is seen at less than 60 degrees.
Errors errors_on(const Solid& solid, const depth::BlockFits& fits) {
  Errors errors;
  for (int row = 0; row < fits.grid.rows; ++row) {
    for (int column = 0; column < fits.grid.columns; ++column) {
      if (fits.states[fits.grid.index(column, row)] != FilteredDepth::State::fitted) continue;
      const Vector3d position = position_of(fits, column, row);
      const Distance exact = distance_and_normal(solid, position);
      if (std::abs(exact.value) > 5e-3) continue;
      if (-exact.gradient.dot(position.normalized()) < 0.5) continue;
      errors.add(solid, position, normal_of(fits, column, row));
    }
  }
  return errors;
}

TEST(Quadric, SeesABallAsItIs) {
  const BentFrame frame(exact_frame({kBall}), kinect_like_noise());
  const auto quadric = frame.quadric(kColumn, kRow);
  ASSERT_TRUE(quadric);
  for (const auto& [u, v] : {std::pair{0, 0}, {10, 4}, {-6, 3}, {2, -10}, {20, 10}}) {
    const auto here = quadric->at(u, v);
    const auto right = quadric->at(u + 1, v);
    const auto left = quadric->at(u - 1, v);
    ASSERT_TRUE(here && right && left);
    const depth::BlockGrid& grid = frame.fits.grid;
    const Vector3d ray(grid.x(kColumn + u), grid.y(kRow + v), 1);
    EXPECT_NEAR(distance_and_normal(kBall, ray / here->rho).value, 0, 1e-4);
    EXPECT_NEAR(here->x, (right->rho - left->rho) / 2, 0.05 * std::abs(here->x) + 1e-5);
    EXPECT_GT(here->variance, 0);
    EXPECT_GT(here->slope_variance, 0);
    EXPECT_TRUE(quadric->holds(u, v, here->rho, 1e-12));
    EXPECT_FALSE(quadric->holds(u, v, here->rho * 1.1, 1e-4));
  }
  EXPECT_FALSE(quadric->at(60, 0));  // beside the ball
  EXPECT_GT(quadric->support, 1000);
}

TEST(Quadric, IsNotFoundWhereNoiseIsSaidToBeTooSmall) {
  const SimulatedNoiseOptions options{.seed = 3};
  NoiseModel noise = options.model;
  const DepthFrame frame = noisy_frame({kBall}, options);
  EXPECT_TRUE(BentFrame(frame, noise).quadric(kColumn, kRow));
  BentFrame told(frame, noise);
  for (double& term : told.noise.coefficients) term /= 3;
  EXPECT_FALSE(told.quadric(kColumn, kRow));
}

TEST(Quadric, IsNotFoundWhereFewBlocksAreBent) {
  BentFrame frame(exact_frame({kBall}), kinect_like_noise());
  std::fill(frame.fits.flat.begin(), frame.fits.flat.end(), simd::kStraight);
  for (int column = 38; column < 43; ++column)
    frame.fits.flat[frame.fits.grid.index(column, 30)] = 0;
  EXPECT_FALSE(frame.quadric(kColumn, kRow));
}

// A block lies on the ball in its mean and its tilts. One of a ball that touches it does not,
// though its own depth is as near.
TEST(Quadric, ExplainsItsOwnBallAndNotOneThatTouchesIt) {
  const Solid ball = sphere({0, 0, 0.66}, 0.03);
  const Solid other = sphere({0.05, 0, 0.66}, 0.02);
  const SimulatedNoiseOptions options{.seed = 4};
  const BentFrame frame(noisy_frame({ball, other}, options), options.model);
  const depth::BlockGrid& grid = frame.fits.grid;
  const depth::SameSurface same(options.model, grid);
  const auto quadric = frame.quadric(kColumn + 9, kRow + 5);
  ASSERT_TRUE(quadric);
  int count[2] = {};  // of its own ball, of the other
  int explained[2] = {};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.index(column, row);
      if (frame.fits.states[i] != FilteredDepth::State::fitted) continue;
      const double x = position_of(frame.fits, column, row).x();
      const bool foreign = x > 0.035;  // a block and a half beyond where they touch
      if (!foreign && x > 0.025) continue;
      const int u = column - quadric->column;
      const int v = row - quadric->row;
      ++count[foreign];
      explained[foreign] += quadric->explains(frame.input().blocks, same, u, v);
    }
  }
  EXPECT_GT(count[0], 200);
  EXPECT_GT(count[1], 60);
  EXPECT_GT(explained[0], 0.95 * count[0]);
  EXPECT_EQ(explained[1], 0);
}

// Two rows say nothing of the way between them and beyond.
TEST(BentFaces, KnowNothingOfTwoRows) {
  const Solid wall = plane({0, 0, 0.8}, {0.3, 0, -1});
  BentFrame frame(noisy_frame({wall}, {.seed = 2}), kinect_like_noise());
  const depth::BlockGrid& grid = frame.fits.grid;
  for (int column = 0; column < grid.columns; ++column) {
    frame.fits.flat[grid.index(column, 28)] = 0;  // a tile's middle looks there
    frame.fits.flat[grid.index(column, 29)] = 0;
  }
  depth::BlockFits fits = frame.fits;
  depth::BentFaces().refit(frame.input(), frame.noise, {.columns = grid.columns, .flags = {}},
                           fits);
  EXPECT_EQ(fits.slope_y, frame.fits.slope_y);
}

// With windows alone they err by 3 degrees.
TEST(BentFaces, KnowNormalsOfBallsUnderNoiseThatHangsTogether) {
  const NoiseModel noise = blurred_noise();
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const SimulatedNoiseOptions options{.kind = NoiseKind::blurred, .seed = seed};
    const BentFrame frame(noisy_frame({kBall}, options), noise);
    const Errors errors = errors_on(kBall, frame.fits);
    ASSERT_GT(errors.count, 900);
    EXPECT_LT(errors.rms_angle(), 1.5 * kDegree) << seed;
  }
}

TEST(BentFaces, KnowNormalsOfCylinders) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0, 0, 0.7);
  pose.rotate(Eigen::AngleAxisd(1.1, Vector3d(1, 0.3, 0).normalized()));
  const Solid cylinder{SolidKind::cylinder, pose, Vector3d(0.04, 0.04, 0.06)};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const BentFrame frame(noisy_frame({cylinder}, {.seed = seed}), kinect_like_noise());
    Errors errors;
    for (int row = 22; row < 38; ++row) {  // away from its ends
      for (int column = 30; column < 50; ++column) {
        const Vector3d position = position_of(frame.fits, column, row);
        errors.add(cylinder, position, normal_of(frame.fits, column, row));
      }
    }
    EXPECT_LT(errors.rms_angle(), 1 * kDegree) << seed;
  }
}

// A ball after a refit before which one block was level and its window as told.
BentFrame refitted_with(simd::Flatness flatness) {
  BentFrame frame(noisy_frame({kBall}, {.seed = 6}), kinect_like_noise());
  const std::size_t i = frame.fits.grid.index(kColumn + 6, kRow + 3);
  frame.fits.flat[i] = flatness;
  frame.fits.slope_x[i] = 0;
  depth::BentFaces().refit(frame.input(), frame.noise,
                           {.columns = frame.fits.grid.columns, .flags = {}}, frame.fits);
  return frame;
}

TEST(BentFaces, AreTakenWhereAPlaneServesByChance) {
  const BentFrame frame = refitted_with(simd::kPlaneNearBy);
  Errors errors;
  errors.add(kBall, position_of(frame.fits, kColumn + 6, kRow + 3),
             normal_of(frame.fits, kColumn + 6, kRow + 3));
  EXPECT_LT(errors.rms_angle(), 1 * kDegree);
}

// A block whose largest window is a plane is no ball's.
TEST(BentFaces, LeaveStraightBlocksAlone) {
  const BentFrame frame = refitted_with(simd::kStraight);
  EXPECT_EQ(frame.fits.slope_x[frame.fits.grid.index(kColumn + 6, kRow + 3)], 0);
}

// Waves that hang together over much of what is looked at may be taken for anything bent.
TEST(Quadric, IsNotFoundInWavesOnAPlane) {
  const Solid wall = plane({0, 0, 0.8}, {0.3, 0, -1});
  NoiseModel noise = kinect_like_noise();
  for (const double correlation : {8., 12., 18.}) {
    noise.correlation = correlation;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      BentFrame frame(noisy_frame({wall}, {.seed = seed, .correlation = correlation}), noise);
      std::fill(frame.fits.flat.begin(), frame.fits.flat.end(), simd::kBentWindow);
      EXPECT_FALSE(frame.quadric(kColumn, kRow)) << correlation << " " << seed;
    }
  }
}

TEST(BentFaces, LeavePlanesAndKeptBlocksAlone) {
  const Solid wall = plane({0, 0, 0.8}, {0.3, 0, -1});
  const BentFrame frame(noisy_frame({kBall, wall}, {.seed = 5}), kinect_like_noise());
  depth::BlockFits fits = frame.fits;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    fits.slope_x[i] = 0;
    fits.confidences[i] = 0;  // nothing is known of its slopes
  }
  const depth::BlockFits before = fits;
  const depth::BlockGrid& grid = fits.grid;
  KeptTiles kept{.columns = grid.columns, .flags = {}};
  kept.flags.assign(kept.index(grid.columns - 1, grid.rows - 1) + 1, 0);
  for (int row = 0; row < grid.rows; ++row) kept.flags[kept.index(36, row)] = 1;
  depth::BentFaces().refit(frame.input(), frame.noise, kept, fits);
  int changed = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.index(column, row);
      const bool same = fits.rho[i] == before.rho[i] && fits.slope_x[i] == before.slope_x[i];
      changed += !same;
      const double off = distance_and_normal(kBall, position_of(before, column, row)).value;
      const bool may = std::abs(off) < 0.01 && !kept.at(column, row);
      EXPECT_TRUE(same || may) << column << " " << row;
    }
  }
  EXPECT_GT(changed, 500);
}

}  // namespace
}  // namespace palpate::test
