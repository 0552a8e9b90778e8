#include <gtest/gtest.h>

#include <random>

#include "contact/probe.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

TEST(Sweep, StopsAtTheExactFirstContactOfABall) {
  const SphereField ball(0.03);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d from(uniform(random), uniform(random), uniform(random));
    const Vector3d to(uniform(random), uniform(random), uniform(random));
    if (from.norm() < 0.03) continue;
    const Vector3d way = to - from;
    const double middle = -from.dot(way) / way.squaredNorm();
    const double nearest2 = (from + middle * way).squaredNorm();
    const double half_chord = std::sqrt(std::max(0.0, 9e-4 - nearest2)) / way.norm();
    const double first = middle - half_chord;
    Probe probe(ball, kNoTexture, 0);
    const Sweep found = first_contact(probe, from, to);
    const bool hit = nearest2 < 9e-4 && first > 0 && first < 1;
    if (2 * half_chord * way.norm() < 2e-5) continue;  // shorter than the field's resolution
    EXPECT_EQ(found.end == Sweep::End::hit, hit);
    if (!hit) continue;
    ++hits;
    EXPECT_GE(found.position.norm(), 0.03);
    EXPECT_NEAR((found.position - from).norm(), first * way.norm(), 2e-5);
  }
  EXPECT_GT(hits, 200);
}

TEST(Sweep, FreeWayCostsOneBall) {
  const SphereField ball(0.03);
  Probe probe(ball, kNoTexture, 0);
  EXPECT_EQ(first_contact(probe, {0.1, 0, 0}, {0.1, 0.05, 0}).end, Sweep::End::clear);
  EXPECT_EQ(probe.evaluations(), 1);
}

TEST(Sweep, NoWayAtAllIsClear) {
  const SphereField ball(0.03);
  Probe probe(ball, kNoTexture, 0);
  const Vector3d place(0.0300001, 0, 0);
  EXPECT_EQ(first_contact(probe, place, place).end, Sweep::End::clear);
}

TEST(Sweep, IsTruncatedWhereItIsStillFreeAndGoesOnNextStep) {
  const DoubtfulField field;
  Probe probe(field, kNoTexture, 0);
  const Sweep found = first_contact(probe, {0, 0, 0}, {0.1, 0, 0});
  EXPECT_EQ(found.end, Sweep::End::truncated);
  EXPECT_GT(found.position.x(), 0);
  EXPECT_LT(found.position.x(), 0.1);
  EXPECT_LE(probe.evaluations(), kSweepWork / kEvaluationWork + 20);

  Proxy proxy;
  proxy.reset({0, 0, 0});
  double reached = 0;
  int steps = 0;
  for (; reached < 0.1 && steps < 100; ++steps) {
    const Contact c = proxy.step(field, {0.1, 0, 0}, 1e-3);
    EXPECT_GT(c.proxy.x(), reached);
    EXPECT_EQ(has(c.notes, ContactNote::sweep_truncated), c.proxy.x() < 0.1);
    EXPECT_EQ(c.force.norm(), 0);
    reached = c.proxy.x();
  }
  EXPECT_LT(steps, 100);
}

TEST(Newton, OneStepIsExactOnADistance) {
  const SphereField ball(0.03);
  Probe probe(ball, kNoTexture, 0);
  const auto found = project(probe, {0.0312, 0, 0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->position.x(), 0.03, 1e-17);
  EXPECT_EQ(probe.evaluations(), 2);
}

TEST(Newton, GivesUpWhereThereIsNoGradientOrNoSurface) {
  const FogField fog;
  Probe in_fog(fog, kNoTexture, 0);
  EXPECT_FALSE(project(in_fog, {0, 0, 0}));
  const EmptyField empty;
  Probe in_nothing(empty, kNoTexture, 0);
  EXPECT_FALSE(project(in_nothing, {0, 0, 0}));
}

TEST(Newton, FartherThanItsStepsReachIsAFailure) {
  const SphereField ball(0.5);
  Probe probe(ball, kNoTexture, 0);
  EXPECT_FALSE(project(probe, {0.54, 0, 0}));
  EXPECT_LE(probe.evaluations(), 11);
  EXPECT_TRUE(project(probe, {0.52, 0, 0}));
}

}  // namespace
}  // namespace palpate::test
