#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/numbers.hpp"
#include "depth/noise_tracker.hpp"

namespace palpate::depth {
namespace {

const NoiseModel kPrior{{0.0004, 0, 0.0025}, 3};

std::vector<NoiseSample> samples_of(const NoiseModel& model, double near, double far, int count) {
  std::vector<NoiseSample> samples;
  for (int i = 0; i < count; ++i) {
    const double z = near * std::pow(far / near, i / (count - 1.0));
    samples.push_back({z, model.sigma(z), 20});
  }
  return samples;
}

TEST(NoiseCurve, FindsAllThreeTermsOverAWideRange) {
  const NoiseModel truth{{0.0015, -0.00152, 0.0019}, 1};
  const NoiseModel found = fit_noise_curve(samples_of(truth, 0.5, 1.6, 7), kPrior);
  for (double z = 0.4; z < 2; z *= 1.1) {
    EXPECT_NEAR(found.sigma(z), truth.sigma(z), 0.005 * truth.sigma(z));
  }
  EXPECT_EQ(found.correlation, kPrior.correlation);
}

TEST(NoiseCurve, OneWrongSampleDoesNotMatter) {
  const NoiseModel truth{{0, 0, 0.0025}, 1};
  std::vector<NoiseSample> samples = samples_of(truth, 0.5, 4, 10);
  samples[3].sigma *= 5;
  const NoiseModel found = fit_noise_curve(samples, kPrior);
  for (const double z : {0.5, 1.0, 2.0, 4.0}) {
    EXPECT_NEAR(found.sigma(z), truth.sigma(z), 0.1 * truth.sigma(z));
  }
}

TEST(NoiseCurve, ANarrowRangeKeepsThePriorsShape) {
  const std::vector<NoiseSample> samples{{0.70, 0.002, 10}, {0.75, 0.0022, 10}};
  const NoiseModel found = fit_noise_curve(samples, kPrior);
  EXPECT_NEAR(found.sigma(0.725), 0.0021, 0.0001);
  EXPECT_NEAR(found.sigma(2) / found.sigma(1), kPrior.sigma(2) / kPrior.sigma(1), 1e-9);
}

TEST(NoiseCurve, NothingGivesThePrior) {
  EXPECT_EQ(fit_noise_curve({}, kPrior).coefficients, kPrior.coefficients);
}

// Whatever the samples are, the noise stays positive and does not run away.
TEST(NoiseCurve, StaysSaneOnNonsense) {
  Random random(7);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<NoiseSample> samples;
    const int count = 1 + static_cast<int>(9 * random.uniform());
    double least = 1;
    double most = 0;
    double near = 1e9;
    for (int i = 0; i < count; ++i) {
      const double z = 0.2 * std::exp(3 * random.uniform());
      const double sigma = 1e-4 * std::exp(4 * random.uniform());
      samples.push_back({z, sigma, 1 + 50 * random.uniform()});
      least = std::min(least, sigma);
      most = std::max(most, sigma);
      near = std::min(near, z);
    }
    const NoiseModel found = fit_noise_curve(samples, kPrior);
    for (double z = 0.1; z < 20; z *= 1.2) {
      ASSERT_GT(found.sigma(z), 0) << trial;
      ASSERT_TRUE(std::isfinite(found.sigma(z)));
    }
    ASSERT_LT(found.sigma(near), 10 * most) << trial;
    ASSERT_GT(found.sigma(20), 0.1 * least) << trial;
  }
}

}  // namespace
}  // namespace palpate::depth
