#include <gtest/gtest.h>

#include "field/formulas.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {
namespace {

class KernelTest : public testing::TestWithParam<Kernel> {};

TEST_P(KernelTest, IsOneAtTheCentreAndZeroFromTheRadiusOn) {
  EXPECT_DOUBLE_EQ(evaluate(GetParam(), 0).w, 1);
  EXPECT_NEAR(evaluate(GetParam(), 1 - 1e-12).w, 0, 1e-11);
  EXPECT_EQ(evaluate(GetParam(), 1).w, 0);
  EXPECT_EQ(evaluate(GetParam(), 5).g, 0);
}

TEST_P(KernelTest, SlopeIsTheDerivativeOverR) {
  constexpr double h = 1e-6;
  for (double r = 0.05; r < 0.999; r += 0.05) {
    const double up = evaluate(GetParam(), (r + h) * (r + h)).w;
    const double down = evaluate(GetParam(), (r - h) * (r - h)).w;
    EXPECT_NEAR(evaluate(GetParam(), r * r).g, (up - down) / (2 * h) / r, 1e-6) << "r = " << r;
  }
}

TEST_P(KernelTest, PlaneThresholdIsTheIntegralOverThePlane) {
  const auto integral = [](double from) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double r = from + (i + 0.5) / kSteps * (1 - from);
      sum += evaluate(GetParam(), r * r).w * r * (1 - from) / kSteps;
    }
    return sum;
  };
  for (const double eta : {0.0, 0.2, 0.49, 0.8, 1.0}) {
    EXPECT_NEAR(plane_threshold(GetParam(), eta), integral(eta) / integral(0), 1e-7);
  }
}

TEST_P(KernelTest, PlaneOffsetInvertsPlaneThreshold) {
  for (const double eta : {0.1, 0.3, 0.49, 0.9}) {
    EXPECT_NEAR(plane_offset(GetParam(), plane_threshold(GetParam(), eta)), eta, 1e-9);
  }
}

TEST_P(KernelTest, PlaneThresholdSlopeIsItsDerivative) {
  constexpr double h = 1e-6;
  for (const double eta : {0.1, 0.49, 0.9}) {
    const double up = plane_threshold(GetParam(), eta + h);
    const double down = plane_threshold(GetParam(), eta - h);
    EXPECT_NEAR(plane_threshold_slope(GetParam(), eta), (up - down) / (2 * h), 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, KernelTest, testing::Values(Kernel::wyvill, Kernel::wendland));

TEST(Kernel, DefaultOffsetIsNearHalfARadius) {
  EXPECT_NEAR(plane_offset(Kernel::wyvill, 0.4), 0.49, 0.005);
}

}  // namespace
}  // namespace palpate
