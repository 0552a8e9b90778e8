#include "accuracy/depth_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/normal_generator.hpp"

namespace palpate::accuracy {
namespace {

double variance(const DepthImage& image) {
  double sum = 0;
  for (const double value : image.depth) sum += value * value;
  return sum / static_cast<double>(image.depth.size());
}

// Mean product of pixels `lag` apart in a row.
double covariance(const DepthImage& image, int lag) {
  double sum = 0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u + lag < image.width; ++u) sum += image.at(u, v) * image.at(u + lag, v);
  }
  return sum / (image.height * (image.width - lag));
}

DepthImage flat(double z) {
  return {160, 120, std::vector<double>(std::size_t{160} * 120, z)};
}

TEST(NormalGenerator, IsTheSameEverywhere) {
  // The engine's 10000th number is fixed by the standard; the transform is ours.
  std::mt19937_64 engine;
  engine.discard(9999);
  EXPECT_EQ(engine(), 9981545732273789042u);
  NormalGenerator a(3);
  NormalGenerator b(3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(DepthNoise, KeepsItsVarianceWhenBlurred) {
  for (const double blur : {0.0, 2.0, 4.0}) {
    EXPECT_NEAR(variance(unit_noise(320, 240, blur, 5)), 1, 0.06) << blur;
  }
}

TEST(DepthNoise, IsCorrelatedAsABlurMakesIt) {
  const DepthImage white = unit_noise(320, 240, 0, 9);
  EXPECT_NEAR(covariance(white, 1), 0, 0.02);
  // A Gaussian blur of s pixels gives exp(-lag^2 / (4 s^2)).
  const DepthImage blurred = unit_noise(320, 240, 2, 9);
  EXPECT_NEAR(covariance(blurred, 2), std::exp(-0.25), 0.05);
  EXPECT_NEAR(covariance(blurred, 4), std::exp(-1.0), 0.05);
}

TEST(DepthNoise, HasTheSensorsDeviationAndWholeMillimetres) {
  for (const NoiseKind kind : {NoiseKind::independent, NoiseKind::blurred}) {
    DepthImage noisy = add_noise(flat(0.8), {kind, 11, false});
    for (double& z : noisy.depth) {
      EXPECT_NEAR(z * 1000, std::round(z * 1000), 1e-9);
      z -= 0.8;
    }
    // Rounding adds 1/12 mm^2.
    const double expected = std::sqrt(depth_sigma(0.8) * depth_sigma(0.8) + 1e-6 / 12);
    EXPECT_NEAR(std::sqrt(variance(noisy)), expected, 0.06 * expected);
  }
  EXPECT_NEAR(depth_sigma(0.7), 0.001371, 1e-9);
}

TEST(DepthNoise, TakesOneFrameForOneSeed) {
  const NoiseOptions options{NoiseKind::quantised, 4, false};
  EXPECT_EQ(add_noise(flat(0.7), options).depth, add_noise(flat(0.7), options).depth);
  EXPECT_NE(add_noise(flat(0.7), options).depth,
            add_noise(flat(0.7), {NoiseKind::quantised, 5, false}).depth);
}

TEST(DepthNoise, DisturbsSilhouettesAlone) {
  DepthImage step = flat(0.6);
  for (int v = 0; v < step.height; ++v) {
    for (int u = 80; u < step.width; ++u) step.at(u, v) = 0.9;
  }
  const DepthImage noisy = add_noise(step, {NoiseKind::independent, 2, true});
  int missing = 0;
  int flying = 0;
  for (int v = 0; v < step.height; ++v) {
    for (int u = 0; u < step.width; ++u) {
      const double z = noisy.at(u, v);
      const bool odd = z == 0 || std::abs(z - step.at(u, v)) > 0.02;
      if (u < 79 || u > 80) {
        EXPECT_FALSE(odd) << u;
      }
      missing += z == 0 ? 1 : 0;
      flying += z > 0 && odd ? 1 : 0;
    }
  }
  EXPECT_NEAR(missing, 60, 25);  // a quarter of two columns
  EXPECT_NEAR(flying, 56, 25);
}

}  // namespace
}  // namespace palpate::accuracy
