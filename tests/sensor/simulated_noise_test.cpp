#include "sim/simulated_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

SimulatedNoiseOptions of_kind(NoiseKind kind, std::uint64_t seed = 5) {
  SimulatedNoiseOptions options;
  options.kind = kind;
  options.seed = seed;
  return options;
}

double variance(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * value;
  return sum / static_cast<double>(values.size());
}

// Between pixels `lag` apart in a row, or in a column, over a few frames.
double correlation(NoiseKind kind, int lag, bool down) {
  SimulatedNoise noise(of_kind(kind));
  double products = 0;
  double squares = 0;
  for (std::uint64_t frame = 0; frame < 4; ++frame) {
    const std::vector<float>& values = noise.unit_noise(kWidth, kHeight, frame);
    for (int v = 0; v + (down ? lag : 0) < kHeight; ++v) {
      for (int u = 0; u + (down ? 0 : lag) < kWidth; ++u) {
        const auto a = static_cast<std::size_t>(v * kWidth + u);
        const std::size_t b = a + static_cast<std::size_t>(down ? lag * kWidth : lag);
        products += static_cast<double>(values[a]) * values[b];
        squares += static_cast<double>(values[a]) * values[a];
      }
    }
  }
  return products / squares;
}

std::vector<float> disturbed(const SimulatedNoiseOptions& options, float z, int frame = 0) {
  std::vector<float> depth(kPixels, z);
  SimulatedNoise(options).apply(kWidth, kHeight, static_cast<std::uint64_t>(frame), depth);
  return depth;
}

TEST(SimulatedNoise, HasTheQuantilesOfANormalDistribution) {
  SimulatedNoise noise(of_kind(NoiseKind::independent));
  std::vector<float> values = noise.unit_noise(kWidth, kHeight, 0);
  std::sort(values.begin(), values.end());
  for (const double z : {-2.5, -1.0, 0.0, 0.5, 2.0}) {
    const double below = 0.5 * std::erfc(-z / std::sqrt(2.0));
    const auto rank = static_cast<std::size_t>(below * static_cast<double>(kPixels));
    EXPECT_NEAR(values[rank], z, 0.05) << z;
  }
  EXPECT_GT(values.back(), 3.8);
}

TEST(SimulatedNoise, KeepsItsVarianceWhenBlurred) {
  for (const NoiseKind kind : {NoiseKind::independent, NoiseKind::blurred, NoiseKind::quantised}) {
    SimulatedNoise noise(of_kind(kind));
    EXPECT_NEAR(variance(noise.unit_noise(kWidth, kHeight, 0)), 1, 0.08);
  }
}

TEST(SimulatedNoise, IsCorrelatedAsABlurMakesIt) {
  for (const bool down : {false, true}) {
    EXPECT_NEAR(correlation(NoiseKind::independent, 1, down), 0, 0.02);
    // A Gaussian blur of s pixels gives exp(-lag^2 / (4 s^2)).
    EXPECT_NEAR(correlation(NoiseKind::blurred, 2, down), std::exp(-0.25), 0.04);
    EXPECT_NEAR(correlation(NoiseKind::blurred, 4, down), std::exp(-1.0), 0.04);
    EXPECT_NEAR(correlation(NoiseKind::quantised, 4, down), std::exp(-0.25), 0.06);
  }
}

TEST(SimulatedNoise, HasTheSensorsDeviationAndWholeMillimetres) {
  for (const NoiseKind kind : {NoiseKind::independent, NoiseKind::blurred}) {
    std::vector<float> noisy = disturbed(of_kind(kind, 11), 0.8f);
    for (float& z : noisy) {
      EXPECT_NEAR(z * 1000, std::round(z * 1000), 1e-4);
      z -= 0.8f;
    }
    // Rounding adds 1/12 mm^2.
    const double sigma = kinect_like_noise().sigma(0.8);
    const double expected = std::sqrt(sigma * sigma + 1e-6 / 12);
    EXPECT_NEAR(std::sqrt(variance(noisy)), expected, 0.06 * expected);
  }
  EXPECT_NEAR(kinect_like_noise().sigma(0.7), 0.001371, 1e-9);
}

TEST(SimulatedNoise, QuantisesDisparity) {
  SimulatedNoiseOptions options = of_kind(NoiseKind::quantised);
  options.rounding = 0;
  for (const float z : disturbed(options, 2.0f)) {
    const double disparity = 8 * 525 * 0.075 / z;  // in eighths of a pixel
    EXPECT_NEAR(disparity, std::round(disparity), 1e-3);
  }
}

TEST(SimulatedNoise, TakesOneFrameForOneSeedAndNumber) {
  const SimulatedNoiseOptions options = of_kind(NoiseKind::quantised, 4);
  EXPECT_EQ(disturbed(options, 0.7f, 3), disturbed(options, 0.7f, 3));
  EXPECT_NE(disturbed(options, 0.7f, 3), disturbed(options, 0.7f, 4));
  EXPECT_NE(disturbed(options, 0.7f, 3), disturbed(of_kind(NoiseKind::quantised, 5), 0.7f, 3));
}

TEST(SimulatedNoise, LeavesHolesAndCanLeaveDepthsAlone) {
  SimulatedNoiseOptions options = of_kind(NoiseKind::none);
  options.rounding = 0;
  EXPECT_EQ(disturbed(options, 0.7123f), std::vector<float>(kPixels, 0.7123f));
  EXPECT_EQ(disturbed(of_kind(NoiseKind::quantised), 0), std::vector<float>(kPixels, 0.0f));
}

TEST(SimulatedNoise, DisturbsSilhouettesAlone) {
  std::vector<float> step(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) step[i] = i % kWidth < 80 ? 0.6f : 0.9f;
  std::vector<float> noisy = step;
  SimulatedNoiseOptions options = of_kind(NoiseKind::independent, 2);
  options.silhouettes = true;
  SimulatedNoise(options).apply(kWidth, kHeight, 0, noisy);
  int missing = 0;
  int flying = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const bool odd = noisy[i] == 0 || std::abs(noisy[i] - step[i]) > 0.02;
    const std::size_t u = i % kWidth;
    if (u != 79 && u != 80) {
      EXPECT_FALSE(odd) << u;
    }
    missing += noisy[i] == 0 ? 1 : 0;
    flying += noisy[i] > 0 && odd ? 1 : 0;
  }
  EXPECT_NEAR(missing, 120, 50);  // a quarter of two columns
  EXPECT_NEAR(flying, 112, 50);
}

TEST(SimulatedNoise, RefusesASenselessRounding) {
  SimulatedNoiseOptions options;
  options.rounding = -1;
  EXPECT_THROW(SimulatedNoise{options}, Error);
}

}  // namespace
}  // namespace palpate
