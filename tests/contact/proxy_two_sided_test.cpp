// Open surfaces: the side is kept while the proxy is in the surface's domain (algorithm.md 1.4, 3).
#include <gtest/gtest.h>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

TEST(TwoSided, IsTouchedFromTheSideTheHandComesFrom) {
  const SheetField sheet;
  for (const double side : {1.0, -1.0}) {
    Proxy proxy;
    const Vector3d from(0.01, 0, 0.03 * side);
    proxy.reset(from);
    drive(proxy, sheet, from, {0.01, 0, -0.02 * side}, 0.1,
          [&](const Vector3d& hip, const Contact& c) {
            EXPECT_NEAR(c.force.z(), side * std::max(0.0, -500 * side * hip.z()), 1e-9);
          });
    EXPECT_EQ(proxy.side(), side);
  }
}

TEST(TwoSided, AFastHandIsStoppedByTheSide) {
  const SheetField sheet;
  for (int phase = 0; phase < 20; ++phase) {
    Proxy proxy;
    const Vector3d from(0, 0, 0.0501 + 1e-3 * phase);
    proxy.reset(from);
    const Contact c = drive(proxy, sheet, from, {0, 0, -0.03}, 5.0);
    EXPECT_NEAR(c.force.z(), 15, 1e-6);
  }
}

TEST(TwoSided, SideIsForgottenOutsideTheDomain) {
  const SheetField sheet;
  Proxy proxy;
  proxy.reset({0, 0, 0.03});
  drive(proxy, sheet, {0, 0, 0.03}, {0, 0, -0.003}, 0.1);
  EXPECT_EQ(proxy.side(), 1);
  drive(proxy, sheet, {0, 0, -0.003}, {0, 0, 0.03}, 0.1);
  EXPECT_EQ(proxy.side(), 0);
  drive(proxy, sheet, {0, 0, 0.03}, {0.08, 0, 0}, 0.1);
  drive(proxy, sheet, {0.08, 0, 0}, {0, 0, -0.03}, 0.1);
  const Contact c = drive(proxy, sheet, {0, 0, -0.03}, {0, 0, 0.003}, 0.1);
  EXPECT_EQ(proxy.side(), -1);
  EXPECT_NEAR(c.force.z(), -1.5, 1e-9);
}

TEST(TwoSided, SlidingOffTheRimLetsTheHandGoAndNeverPulls) {
  const SheetField sheet;
  Proxy proxy;
  proxy.reset({0, 0, 0.03});
  drive(proxy, sheet, {0, 0, 0.03}, {0, 0, -0.003}, 0.1);
  const Contact c = drive(proxy, sheet, {0, 0, -0.003}, {0.07, 0, -0.003}, 0.1,
                          [](const Vector3d&, const Contact& now) { EXPECT_GE(now.force.z(), 0); });
  EXPECT_FALSE(c.touching);
}

TEST(TwoSided, AHandThatStartsBehindIsNotKicked) {
  const SheetField sheet;
  Proxy proxy;
  const Contact first = proxy.step(sheet, {0, 0, -0.002}, kTick);
  EXPECT_EQ(first.force.norm(), 0);
  EXPECT_FALSE(first.touching);
  const Contact c = drive(proxy, sheet, {0, 0, -0.002}, {0, 0, 0.002}, 0.1);
  EXPECT_NEAR(c.force.z(), -1, 1e-9);
}

}  // namespace
}  // namespace palpate::test
