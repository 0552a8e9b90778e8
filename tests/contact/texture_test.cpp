#include <gtest/gtest.h>

#include <random>

#include "contact/drive.hpp"
#include "contact/probe.hpp"
#include "palpate/field/analytic.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr Texture kFineTexture{.amplitude = 1e-4, .wavelength = 4e-3};

TEST(Texture, IsCarvedNotRaisedAndUsesItsDepth) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.02, 0.02);
  double lowest = 0;
  double highest = -1;
  for (int i = 0; i < 20000; ++i) {
    const double height =
        relief_at(kFineTexture, {uniform(random), uniform(random), uniform(random)}).height;
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  EXPECT_LE(highest, 0);
  EXPECT_GT(highest, -0.1 * kFineTexture.amplitude);
  EXPECT_GE(lowest, -2 * kFineTexture.amplitude);
  EXPECT_LT(lowest, -1.9 * kFineTexture.amplitude);
}

TEST(Texture, GradientAgreesWithCentralDifferences) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Vector3d x(uniform(random), uniform(random), uniform(random));
    const Vector3d gradient = relief_at(kFineTexture, x).gradient;
    constexpr double kStep = 1e-7;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kStep * Vector3d::Unit(axis);
      const double difference =
          (relief_at(kFineTexture, x + step).height - relief_at(kFineTexture, x - step).height) /
          (2 * kStep);
      EXPECT_NEAR(difference, gradient[axis], 1e-7);
    }
  }
}

TEST(Texture, NoAmplitudeIsNoRelief) {
  const Relief relief = relief_at({.amplitude = 0, .wavelength = 1e-3}, {1, 2, 3});
  EXPECT_EQ(relief.height, 0);
  EXPECT_EQ(relief.gradient.norm(), 0);
}

TEST(Texture, ModulatesTheForceAndGivesNoEnergyAroundALoop) {
  const PlaneField plane;
  Proxy proxy{{.texture = kFineTexture}};
  const Vector3d center(0, 0, -0.003);
  proxy.reset({0.01, 0, 0.01});
  drive(proxy, plane, {0.01, 0, 0.01}, {0.01, 0, -0.003}, 0.1);
  constexpr int kSteps = 1000;
  double least = 1e9;
  double most = 0;
  for (int lap = 0; lap < 3; ++lap) {
    double given = 0;
    Vector3d last_hip = center + Vector3d(0.01, 0, 0);
    Vector3d last_force = proxy.step(plane, last_hip, kTick).force;
    for (int i = 1; i <= kSteps; ++i) {
      const double angle = 2 * M_PI * i / kSteps;
      const Vector3d hip = center + 0.01 * Vector3d(std::cos(angle), std::sin(angle), 0);
      const Contact contact = proxy.step(plane, hip, kTick);
      given += 0.5 * (contact.force + last_force).dot(hip - last_hip);
      least = std::min(least, contact.force.norm());
      most = std::max(most, contact.force.norm());
      last_hip = hip;
      last_force = contact.force;
      ASSERT_TRUE(contact.touching);
    }
    EXPECT_LT(given, 1.5e-4) << lap;
    EXPECT_GT(given, -1.5e-4) << lap;
  }
  EXPECT_GT(most - least, 0.3 * 500 * kFineTexture.amplitude);
  EXPECT_LT(most, 500 * 0.003 + 0.01);
}

}  // namespace
}  // namespace palpate::test
