// The last resort: no hand is held in free air for long (ContactNote::freed).
#include <gtest/gtest.h>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// A plate 4 mm thick; R is 10 mm, so a hand 100 mm from its proxy is far away.
const BoxField& plate() {
  static const BoxField field({0.4, 0.4, 0.004});
  return field;
}

Proxy held_at(double depth) {
  Proxy proxy;
  proxy.reset({0, 0, 0.05});
  drive(proxy, plate(), {0, 0, 0.05}, {0, 0, -depth}, 0.5, [](const Vector3d&, const Contact&) {});
  return proxy;
}

struct Wait {
  int first_noted = -1;  // tick
  double largest_rise = 0;
  double largest_fall = 0;
  Contact last;
};

Wait wait(Proxy& proxy, const Vector3d& hand, int ticks) {
  Wait wait;
  double before = 1e9;
  for (int i = 0; i < ticks; ++i) {
    wait.last = proxy.step(plate(), hand, kTick);
    const bool noted = has(wait.last.notes, ContactNote::freed);
    if (noted && wait.first_noted < 0) wait.first_noted = i;
    wait.largest_rise = std::max(wait.largest_rise, wait.last.force.norm() - before);
    if (before < 1e9)
      wait.largest_fall = std::max(wait.largest_fall, before - wait.last.force.norm());
    before = wait.last.force.norm();
  }
  return wait;
}

TEST(Freed, AHandFarBehindAPlateIsLetGoAfterASecondInHalfASecond) {
  Proxy proxy = held_at(0.15);
  const Vector3d hand(0, 0, -0.15);
  const Wait first = wait(proxy, hand, 850);
  EXPECT_EQ(first.first_noted, -1);
  EXPECT_NEAR(first.last.force.norm(), 500 * 0.152, 0.1);
  const Wait then = wait(proxy, hand, 400);
  EXPECT_GT(then.first_noted, 0);
  EXPECT_LT(then.last.force.norm(), 0.7 * 500 * 0.152);
  EXPECT_LE(then.largest_rise, 1e-9);
  const Wait end = wait(proxy, hand, 500);
  EXPECT_LT(std::max(then.largest_fall, end.largest_fall), 0.8);
  EXPECT_FALSE(end.last.touching);
  EXPECT_EQ(end.last.force.norm(), 0);
  EXPECT_LE(end.largest_rise, 1e-9);
  EXPECT_EQ(proxy.position(), hand);
}

TEST(Freed, AHandThatPressesLessDeepOrIntoSomethingSolidIsHeldForGood) {
  Proxy near = held_at(0.09);
  EXPECT_EQ(wait(near, {0, 0, -0.09}, 3000).first_noted, -1);
  const BoxField block({0.4, 0.4, 0.8});
  Proxy deep;
  deep.reset({0, 0, 0.5});
  bool noted = false;
  drive(deep, block, {0, 0, 0.5}, {0, 0, 0.2}, 0.5, [](const Vector3d&, const Contact&) {});
  for (int i = 0; i < 3000; ++i) {
    noted = noted || has(deep.step(block, {0, 0, 0.2}, kTick).notes, ContactNote::freed);
  }
  EXPECT_FALSE(noted);
}

// The inside of a body whose surface alone is known is free air, too.
TEST(Freed, AHandThatPressesAThinSurfaceWithLessThanTenNewtonsIsHeldForGood) {
  const BoxField skin({0.4, 0.4, 2e-4});
  Proxy proxy({.stiffness = 60});
  proxy.reset({0, 0, 0.05});
  drive(proxy, skin, {0, 0, 0.05}, {0, 0, -0.15}, 0.5);
  for (int i = 0; i < 3000; ++i) {
    EXPECT_FALSE(has(proxy.step(skin, {0, 0, -0.15}, kTick).notes, ContactNote::freed));
  }
}

}  // namespace
}  // namespace palpate::test
