// Bad input, hostile fields, bounded work, the same answer twice.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"
#include "palpate/base/error.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

void expect_latched(const Vector3d& hip, double dt) {
  const PlaneField plane;
  Proxy proxy;
  proxy.reset({0, 0, 0.01});
  drive(proxy, plane, {0, 0, 0.01}, {0, 0, -0.003}, 0.1);
  const Contact bad = proxy.step(plane, hip, dt);
  EXPECT_TRUE(has(bad.notes, ContactNote::fault));
  EXPECT_EQ(bad.force.norm(), 0);
  EXPECT_TRUE(bad.proxy.allFinite());
  const Contact after = proxy.step(plane, {0, 0, -0.003}, kTick);
  EXPECT_TRUE(has(after.notes, ContactNote::fault));
  EXPECT_EQ(after.force.norm(), 0);
  proxy.reset({0, 0, 0.01});
  EXPECT_NEAR(proxy.step(plane, {0, 0, -0.003}, kTick).force.z(), 1.5, 1e-9);
}

TEST(Input, WhatIsNotFiniteLatchesAFaultUntilReset) {
  expect_latched({kNaN, 0, 0}, kTick);
  expect_latched({0, kInf, 0}, kTick);
  expect_latched({0, 0, -kInf}, kTick);
  expect_latched({0, 0, 0}, kNaN);
  expect_latched({0, 0, 0}, kInf);
  expect_latched({0, 0, 0}, -1e-3);
}

TEST(Input, HugeCoordinatesAreAFaultToo) {
  expect_latched({1e300, 0, 0}, kTick);
  expect_latched({0, 0, 1.1e9}, kTick);
}

TEST(Input, ResetToNowhereIsAFault) {
  Proxy proxy;
  proxy.reset({kNaN, 0, 0});
  EXPECT_TRUE(proxy.position().allFinite());
  EXPECT_TRUE(has(proxy.step(PlaneField{}, {0, 0, 0}, kTick).notes, ContactNote::fault));
}

TEST(Input, AnyTimeStepFromZeroOnIsTaken) {
  const PlaneField plane;
  for (const double dt : {0.0, 1e-300, 1e300}) {
    Proxy proxy{
        {.friction = {.static_coefficient = 0.3, .dynamic_coefficient = 0.2, .viscous = 2}}};
    proxy.reset({0, 0, 0.01});
    for (int i = 0; i < 50; ++i) {
      const Contact c = proxy.step(plane, {1e-4 * i, 0, -1e-4 * i}, dt);
      EXPECT_TRUE(c.force.allFinite());
      EXPECT_FALSE(has(c.notes, ContactNote::fault));
    }
  }
}

TEST(Input, AJumpOfTheHandAcrossTheWorldIsSweptToTheEnd) {
  const PlaneField plane;
  Proxy proxy;
  proxy.reset({0, 0, 1e8});
  Contact c;
  for (int i = 0; i < 50 && !c.touching; ++i) c = proxy.step(plane, {5, 0, -0.01}, kTick);
  EXPECT_TRUE(c.touching);
  // The first contact lies far away on the plane; from there the proxy goes home step by step.
  EXPECT_TRUE(c.force.allFinite());
}

TEST(Input, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(Proxy{{.stiffness = -1}}, Error);
  EXPECT_THROW(Proxy{{.stiffness = kNaN}}, Error);
  EXPECT_THROW((Proxy{{.friction = {.static_coefficient = 0.2, .dynamic_coefficient = 0.3}}}),
               Error);
  EXPECT_THROW(Proxy{{.friction = {.static_coefficient = -0.2}}}, Error);
  EXPECT_THROW(Proxy{{.friction = {.viscous = kInf}}}, Error);
  EXPECT_THROW(Proxy{{.texture = {.amplitude = -1e-4}}}, Error);
  EXPECT_THROW(Proxy{{.texture = {.wavelength = 0}}}, Error);
  EXPECT_THROW(Proxy{{.max_iterations = 0}}, Error);
  EXPECT_THROW(Proxy{{.max_iterations = 1 << 20}}, Error);
  EXPECT_THROW(Proxy{{.tangent_tolerance = 0}}, Error);
  EXPECT_THROW(Proxy{{.rise_time = 0}}, Error);
}

/// Says anything: values from a hash of the place. `broken` adds what no field may say.
class HostileField final : public Field {
 public:
  explicit HostileField(bool broken) : broken_(broken) {}

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const double h = hash(x);
    Sample sample{.value = 0.01 * (h - 0.3), .support = h, .radius = 0.01 * h};
    sample.gradient = Vector3d(hash(2 * x) - 0.5, hash(3 * x) - 0.5, hash(5 * x) - 0.5);
    if (broken_ && h > 0.98) sample.gradient.x() = kNaN;
    if (broken_ && h < 0.02) sample.value = kInf;
    if (broken_ && h > 0.2 && h < 0.22) sample.radius = 1e300;
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return hash(ball.center) > 0.7;
  }
  [[nodiscard]] Surface surface(const Vector3d& x) const noexcept override {
    return {.stiffness_factor = broken_ && hash(x) > 0.9 ? kNaN : 3 * hash(x) - 1};
  }
  [[nodiscard]] Field::Traits traits() const noexcept override {
    return {.resolution = 1e-7, .revision = ++revision_, .reanchor_reach = 0.01, .step = 0.01};
  }

 private:
  static double hash(const Vector3d& x) {
    std::uint64_t bits = 0;
    for (int i = 0; i < 3; ++i) {
      bits = (bits ^ std::bit_cast<std::uint64_t>(x[i])) * 0x9e3779b97f4a7c15u;
      bits ^= bits >> 29;
    }
    return static_cast<double>(bits >> 11) * 0x1p-53;
  }
  bool broken_;
  mutable std::uint64_t revision_ = 0;
};

TEST(Input, HostileFieldsCostABoundedNumberOfEvaluationsAndGiveFiniteForces) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.01);
  int most = 0;
  for (const bool broken : {false, true}) {
    const HostileField field(broken);
    for (const int iterations : {1, 20, 100}) {
      Proxy proxy{{.friction = {.static_coefficient = 0.3, .dynamic_coefficient = 0.2},
                   .texture = {.amplitude = 1e-4},
                   .max_iterations = iterations}};
      for (int i = 0; i < 3000; ++i) {
        const Contact c =
            proxy.step(field, Vector3d(normal(random), normal(random), normal(random)), kTick);
        ASSERT_TRUE(c.force.allFinite());
        ASSERT_TRUE(c.proxy.allFinite());
        ASSERT_LE(c.evaluations, proxy.max_evaluations());
        if (iterations == 20) most = std::max(most, c.evaluations);
        if (has(c.notes, ContactNote::fault)) proxy.reset(Vector3d::Zero());
      }
    }
  }
  RecordProperty("most_evaluations", most);
}

/// Solid at the origin, with its surface beyond the end of the world.
class AbyssField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const bool near = x.norm() < 1;
    return {.value = near ? -1e300 : 0,
            .gradient = Vector3d::UnitX(),
            .support = 1,
            .radius = near ? 1e300 : 1};
  }
  [[nodiscard]] bool is_free(const Ball&) const noexcept override { return false; }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {.resolution = 1e-3}; }
};

TEST(Input, AProxyThatAFieldThrowsOutOfTheWorldIsAFault) {
  Proxy proxy;
  const Contact c = proxy.step(AbyssField{}, {0, 0, 0}, kTick);
  EXPECT_TRUE(has(c.notes, ContactNote::fault));
  EXPECT_EQ(c.force.norm(), 0);
  EXPECT_EQ(c.proxy.norm(), 0);
}

TEST(Input, SameInputGivesTheSameForcesBitForBit) {
  const BoxField box({0.04, 0.04, 0.04});
  const TorusField torus(0.04, 0.015);
  const UnionField field({&box, &torus});
  const auto run = [&] {
    std::vector<std::uint64_t> bits;
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, 1e-3);
    Proxy proxy{{.friction = {.static_coefficient = 0.3, .dynamic_coefficient = 0.2},
                 .texture = {.amplitude = 1e-5}}};
    Vector3d hip(0, 0, 0.05);
    for (int i = 0; i < 5000; ++i) {
      hip = 0.995 * hip + Vector3d(normal(random), normal(random), normal(random));
      const Contact c = proxy.step(field, hip, kTick);
      for (int axis = 0; axis < 3; ++axis)
        bits.push_back(std::bit_cast<std::uint64_t>(c.force[axis]));
    }
    return bits;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace palpate::test
