#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "palpate/base/error.hpp"
#include "sim/simulated_noise.hpp"

// What sensors do besides noise: each fault alone, on a plane or a step of depth.

namespace palpate {
namespace {

constexpr int kAcross = 320;
constexpr int kDown = 240;
constexpr std::size_t kAll = std::size_t{kAcross} * kDown;
constexpr int kEdge = 80;  // first pixel of the farther side
constexpr float kNear = 0.6f;
constexpr float kFar = 0.9f;

std::size_t at(int u, int v) {
  return static_cast<std::size_t>(v) * kAcross + static_cast<std::size_t>(u);
}

std::vector<float> step_edge() {
  std::vector<float> depth(kAll);
  for (std::size_t i = 0; i < kAll; ++i) depth[i] = i % kAcross < kEdge ? kNear : kFar;
  return depth;
}

// From 0.6 to 0.76 m along rows; all rows are the same.
std::vector<float> slanted() {
  std::vector<float> depth(kAll);
  for (std::size_t i = 0; i < kAll; ++i) {
    depth[i] = 0.6f + 5e-4f * static_cast<float>(i % kAcross);
  }
  return depth;
}

SimulatedNoiseOptions silent() {
  SimulatedNoiseOptions options;
  options.kind = NoiseKind::none;
  options.rounding = 0;
  options.seed = 3;
  return options;
}

std::vector<float> seen(const SimulatedNoiseOptions& options, std::vector<float> depth,
                        std::uint64_t frame = 0) {
  SimulatedNoise(options).apply(kAcross, kDown, frame, depth);
  return depth;
}

double share_without(const std::vector<float>& depth) {
  return static_cast<double>(std::count(depth.begin(), depth.end(), 0.0f)) /
         static_cast<double>(depth.size());
}

TEST(SimulatedFaults, TerracesAreWholeStepsOfDisparity) {
  SimulatedNoiseOptions options = silent();
  options.disparity_step = 1 / 8.0;
  const std::vector<float> exact = slanted();
  const std::vector<float> depth = seen(options, exact);
  for (std::size_t i = 0; i < kAll; ++i) {
    const double steps = 8 * 525 * 0.075 / depth[i];
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
    ASSERT_LT(std::abs(steps - 8 * 525 * 0.075 / exact[i]), 0.76);  // a half and a quarter
  }
  const std::size_t terraces = std::set<float>(depth.begin(), depth.end()).size();
  EXPECT_NEAR(static_cast<double>(terraces), 8 * 525 * 0.075 * (1 / 0.6 - 1 / 0.7595), 2);
  options.disparity_step = 1 / 32.0;
  const std::vector<float> finer = seen(options, exact);
  EXPECT_GT(std::set<float>(finer.begin(), finer.end()).size(), 3 * terraces);
}

TEST(SimulatedFaults, RowsOfTerracesJumpByTheSameInEachFrame) {
  SimulatedNoiseOptions options = silent();
  options.disparity_step = 1 / 8.0;
  const std::vector<float> depth = seen(options, slanted());
  EXPECT_EQ(depth, seen(options, slanted(), 9));
  int other = 0;
  for (int v = 1; v < kDown; ++v) {
    other += std::equal(&depth[at(0, v)], &depth[at(0, v)] + kAcross, &depth[at(0, v - 1)]) ? 0 : 1;
  }
  EXPECT_GT(other, kDown * 9 / 10);
  options.seed = 4;
  EXPECT_NE(depth, seen(options, slanted()));
}

TEST(SimulatedFaults, RimsOfTheNearerSideGoOnAndBend) {
  for (const double curl : {0.018, -0.018}) {
    SimulatedNoiseOptions options = silent();
    options.curl = curl;
    const std::vector<float> depth = seen(options, step_edge());
    EXPECT_EQ(depth, seen(options, step_edge(), 5)) << "it stays with the image";
    int reached = 0;
    for (int v = 0; v < kDown; ++v) {
      for (int u = 0; u < kAcross; ++u) {
        const int place = u - kEdge + 4;  // 1 to 6 on a rim
        const double rim = kNear + curl * place * place / 36;
        const float z = depth[at(u, v)];
        if (place < 1 || place > 6) {
          ASSERT_EQ(z, u < kEdge ? kNear : kFar) << u;
        } else if (place <= 4) {
          ASSERT_NEAR(z, rim, 1e-6) << u;
        } else {
          ASSERT_TRUE(z == kFar || std::abs(z - rim) < 1e-6) << u;
          reached += z < kFar ? 1 : 0;
        }
      }
    }
    EXPECT_NEAR(reached, kDown, kDown / 3) << "two pixels on average";
  }
}

TEST(SimulatedFaults, CurlLeavesFlyingPixelsToTheFartherSide) {
  SimulatedNoiseOptions options = silent();
  options.curl = 0.018;
  const std::vector<float> bent = seen(options, step_edge());
  options.silhouettes = true;
  const std::vector<float> depth = seen(options, step_edge());
  int flying = 0;
  int missing = 0;
  for (std::size_t i = 0; i < kAll; ++i) {
    if (bent[i] < kFar) {
      ASSERT_EQ(depth[i], bent[i]);
    }
    missing += depth[i] == 0 ? 1 : 0;
    flying += depth[i] > 0 && depth[i] != bent[i] ? 1 : 0;
  }
  EXPECT_NEAR(missing, kDown / 4, kDown / 8);
  EXPECT_NEAR(flying, kDown / 4, kDown / 8);
}

TEST(SimulatedFaults, MixedPixelsTellTheMeanOfWhatTheySee) {
  SimulatedNoiseOptions options = silent();
  options.mixed = 0.5;
  const std::vector<float> depth = seen(options, step_edge());
  const double beside = std::exp(-2.0);  // weight of the next column; farther ones have none
  const auto mean = [&](double near_light, double far_light) {
    const double near_share = near_light / (kNear * kNear);
    const double far_share = far_light / (kFar * kFar);
    return (near_share * kNear + far_share * kFar) / (near_share + far_share);
  };
  EXPECT_NEAR(depth[at(kEdge - 1, 100)], mean(1 + beside, beside), 1e-5);
  EXPECT_NEAR(depth[at(kEdge, 100)], mean(beside, 1 + beside), 1e-5);
  EXPECT_GT(depth[at(kEdge - 1, 100)], kNear + 0.01);
  EXPECT_LT(depth[at(kEdge, 100)], kFar - 0.03);
  EXPECT_EQ(depth[at(kEdge - 2, 100)], kNear);
  EXPECT_EQ(depth[at(kEdge + 1, 100)], kFar);
  EXPECT_EQ(seen(options, slanted()), slanted()) << "no depth jumps";
}

TEST(SimulatedFaults, APatternIsTheSameInAllFrames) {
  SimulatedNoiseOptions options = silent();
  options.pattern = 0.002;
  const std::vector<float> plane(kAll, 0.8f);
  const std::vector<float> depth = seen(options, plane);
  EXPECT_EQ(depth, seen(options, plane, 77));
  double squares = 0;
  for (const float z : depth) squares += (z - 0.8) * (z - 0.8);
  EXPECT_NEAR(std::sqrt(squares / kAll), 0.002, 5e-5);
  options.seed = 4;
  EXPECT_NE(depth, seen(options, plane));
  options.kind = NoiseKind::independent;
  options.model.coefficients = {0.004, 0, 0};
  squares = 0;
  for (const float z : seen(options, plane)) squares += (z - 0.8) * (z - 0.8);
  EXPECT_NEAR(std::sqrt(squares / kAll), std::hypot(0.004, 0.002), 1e-4) << "noise comes on top";
}

TEST(SimulatedFaults, HolesComeAndGoWithinAFewFrames) {
  for (const double share : {0.02, 0.3}) {
    SimulatedNoiseOptions options = silent();
    options.holes = share;
    SimulatedNoise noise(options);
    std::vector<std::vector<float>> frames;
    double mean = 0;
    for (std::uint64_t frame = 0; frame < 20; ++frame) {
      frames.push_back(step_edge());
      noise.apply(kAcross, kDown, frame, frames.back());
      mean += share_without(frames.back()) / 20;
    }
    EXPECT_NEAR(mean, share, 0.15 * share);
    EXPECT_EQ(frames[13], seen(options, step_edge(), 13)) << "whatever came before";
    const auto stays = [&](std::size_t later) {
      int both = 0;
      int one = 0;
      for (std::size_t i = 0; i < kAll; ++i) {
        one += frames[0][i] == 0 ? 1 : 0;
        both += frames[0][i] == 0 && frames[later][i] == 0 ? 1 : 0;
      }
      return static_cast<double>(both) / one;
    };
    EXPECT_GT(stays(1), 0.5);
    EXPECT_LT(stays(1), 0.95);
    EXPECT_LT(stays(9), share + 0.1) << "none lasts longer than 8";
  }
}

std::vector<float> flat(float z) {
  return std::vector<float>(kAll, z);
}

TEST(SimulatedFaults, OneFrameInFourHopsAsAWhole) {
  SimulatedNoiseOptions options;
  options.kind = NoiseKind::none;
  options.rounding = 0;
  options.hops = 0.01;
  int off = 0;
  for (std::uint64_t frame = 0; frame < 200; ++frame) {
    const std::vector<float> depth = seen(options, flat(kNear), frame);
    ASSERT_EQ(std::set<float>(depth.begin(), depth.end()).size(), 1u);
    EXPECT_LE(std::abs(depth[0] - kNear), 0.01001f);
    off += depth[0] == kNear ? 0 : 1;
  }
  EXPECT_GT(off, 30);
  EXPECT_LT(off, 70);
}

// The variance of the mean over a large square is the sum of the autocorrelation over its pixels.
TEST(SimulatedFaults, CorrelationIsThatOfNoiseModels) {
  constexpr int kSide = 60;
  SimulatedNoiseOptions options;
  options.rounding = 0;
  options.correlation = 8;
  options.model.coefficients = {1e-3, 0, 0};
  double squares = 0;
  int means = 0;
  for (std::uint64_t frame = 0; frame < 40; ++frame) {
    const std::vector<float> depth = seen(options, flat(kFar), frame);
    for (int top = 0; top + kSide <= kDown; top += kSide) {
      for (int left = 0; left + kSide <= kAcross; left += kSide, ++means) {
        double sum = 0;
        for (int v = top; v < top + kSide; ++v) {
          for (int u = left; u < left + kSide; ++u) sum += depth[at(u, v)] - kFar;
        }
        squares += sum * sum / (kSide * kSide);
      }
    }
  }
  EXPECT_NEAR(std::sqrt(squares / means) / 1e-3, 8, 0.8);
}

// Noise goes, the jump stays.
TEST(SimulatedFaults, SmoothingKeepsJumps) {
  SimulatedNoiseOptions options;
  options.rounding = 0;
  const auto roughness = [&](int smoothing) {
    options.smoothing = smoothing;
    const std::vector<float> depth = seen(options, step_edge(), 1);
    EXPECT_NEAR(depth[at(kEdge - 1, 50)], kNear, 0.01);
    EXPECT_NEAR(depth[at(kEdge, 50)], kFar, 0.01);
    double sum = 0;
    for (int u = 100; u < 300; ++u) sum += std::abs(depth[at(u, 100)] - kFar);
    return sum;
  };
  EXPECT_LT(roughness(3), 0.4 * roughness(0));
}

TEST(SimulatedFaults, AreTheSameForOneSeedAndNumberAndNoneWhenOff) {
  SimulatedNoiseOptions options;
  options.seed = 8;
  options.silhouettes = true;
  const std::vector<float> plain = seen(options, step_edge(), 4);
  for (double SimulatedNoiseOptions::*fault :
       {&SimulatedNoiseOptions::disparity_step, &SimulatedNoiseOptions::curl,
        &SimulatedNoiseOptions::mixed, &SimulatedNoiseOptions::pattern,
        &SimulatedNoiseOptions::holes}) {
    SimulatedNoiseOptions faulty = options;
    faulty.*fault = 0.05;
    const std::vector<float> depth = seen(faulty, step_edge(), 4);
    EXPECT_EQ(depth, seen(faulty, step_edge(), 4));
    if (fault == &SimulatedNoiseOptions::mixed) faulty.*fault = 0.5;  // 0.05 sees nothing beside
    EXPECT_NE(seen(faulty, step_edge(), 4), plain);
    faulty.*fault = 0;
    EXPECT_EQ(seen(faulty, step_edge(), 4), plain);
    for (const double wrong : {-0.2, 10.0, std::nan("")}) {
      faulty.*fault = wrong;
      EXPECT_THROW(SimulatedNoise{faulty}, Error);
    }
  }
}

}  // namespace
}  // namespace palpate
