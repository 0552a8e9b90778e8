#include "palpate/field/analytic.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Eigen::Isometry3d some_pose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Vector3d(0.1, -0.2, 0.3));
  pose.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  return pose;
}

struct Shapes {
  AnalyticField::Options options{.T_world_shape = some_pose(), .tool_radius = 0.002};
  PlaneField plane{options};
  SphereField sphere{0.05, options};
  BoxField box{{0.06, 0.1, 0.08}, options};
  TorusField torus{0.06, 0.02, options};
  UnionField all{{&plane, &sphere, &box, &torus}};
  std::vector<const Field*> fields{&plane, &sphere, &box, &torus, &all};
};

Vector3d random_place(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-0.12, 0.12);
  return some_pose() * Vector3d(uniform(random), uniform(random), uniform(random));
}

TEST(Analytic, GradientAgreesWithCentralDifferencesAndHasUnitLength) {
  const Shapes shapes;
  std::mt19937 random(1);
  for (const Field* field : shapes.fields) {
    int kinks = 0;
    for (int i = 0; i < 500; ++i) {
      const Vector3d x = random_place(random);
      const Sample here = field->sample(x);
      constexpr double kStep = 1e-7;
      Vector3d difference;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = kStep * Vector3d::Unit(axis);
        difference[axis] =
            (field->sample(x + step).value - field->sample(x - step).value) / (2 * kStep);
      }
      EXPECT_NEAR(here.gradient.norm(), 1, 1e-12);
      kinks += (difference - here.gradient).norm() > 1e-6 ? 1 : 0;
    }
    EXPECT_LE(kinks, 2);
  }
}

TEST(Analytic, DistanceLeadsToTheSurface) {
  const Shapes shapes;
  std::mt19937 random(2);
  for (const Field* field : shapes.fields) {
    for (int i = 0; i < 200; ++i) {
      const Vector3d x = random_place(random);
      const Sample here = field->sample(x);
      if (here.value <= 0) continue;
      EXPECT_NEAR(field->sample(x - here.value * here.gradient).value, 0, 1e-14);
    }
  }
}

TEST(Analytic, ABallIsFreeExactlyUpToTheSurface) {
  const Shapes shapes;
  std::mt19937 random(3);
  for (const Field* field : shapes.fields) {
    for (int i = 0; i < 200; ++i) {
      const Vector3d x = random_place(random);
      const double value = field->sample(x).value;
      if (value > 0) {
        EXPECT_TRUE(field->is_free({x, value * (1 - 1e-9)}));
        EXPECT_FALSE(field->is_free({x, value * (1 + 1e-9)}));
      } else {
        EXPECT_FALSE(field->is_free({x, 0}));
      }
    }
  }
}

TEST(Analytic, KnownDistances) {
  EXPECT_DOUBLE_EQ(PlaneField().sample({1, 2, -0.3}).value, -0.3);
  EXPECT_DOUBLE_EQ(SphereField(0.5).sample({0, 2, 0}).value, 1.5);
  EXPECT_DOUBLE_EQ(BoxField({2, 2, 2}).sample({4, 5, 1}).value, 5);
  EXPECT_DOUBLE_EQ(BoxField({2, 2, 2}).sample({0.25, 0, 0.5}).value, -0.5);
  EXPECT_DOUBLE_EQ(TorusField(3, 1).sample({0, 3, 4}).value, 3);
  EXPECT_DOUBLE_EQ(TorusField(3, 1).sample({0, 0, 0}).value, 2);
}

TEST(Analytic, CentresGiveFiniteUnitGradients) {
  const SphereField sphere(1);
  const BoxField box({1, 1, 1});
  const TorusField torus(2, 1);
  for (const Field* field : std::vector<const Field*>{&sphere, &box, &torus}) {
    for (const Vector3d& x : {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(0, 0, 1)}) {
      const Sample here = field->sample(x);
      EXPECT_TRUE(std::isfinite(here.value));
      EXPECT_NEAR(here.gradient.norm(), 1, 1e-12);
    }
  }
}

TEST(Analytic, ToolRadiusPushesTheSurfaceOut) {
  EXPECT_DOUBLE_EQ(SphereField(0.05, {.tool_radius = 0.01}).sample({0.1, 0, 0}).value, 0.04);
}

TEST(Analytic, MovingTheShapeRaisesTheRevision) {
  PlaneField plane;
  const auto before = plane.traits().revision;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Vector3d(0, 0, 0.01));
  plane.set_pose(pose);
  EXPECT_GT(plane.traits().revision, before);
  EXPECT_DOUBLE_EQ(plane.sample({0, 0, 0.03}).value, 0.02);
}

TEST(Analytic, UnionTellsWhichPartIsTouched) {
  AnalyticField::Options beside;
  beside.T_world_shape.translate(Vector3d(1, 0, 0));
  const SphereField left(0.1);
  const SphereField right(0.1, beside);
  const UnionField both({&left, &right});
  EXPECT_EQ(both.surface({0.1, 0, 0}).source, 0);
  EXPECT_EQ(both.surface({0.9, 0, 0}).source, 1);
}

/// One that says what a sample of it costs.
class SummingField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d&) const noexcept override { return {.value = 1}; }
  [[nodiscard]] bool is_free(const Ball&) const noexcept override { return true; }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Field::Traits traits() const noexcept override { return {}; }
  [[nodiscard]] int points_summed() const noexcept override { return 700; }
};

TEST(Analytic, UnionCostsWhatItsPartsCost) {
  const SummingField points;
  const SphereField sphere(0.1);
  EXPECT_EQ(UnionField({&points, &sphere, &points}).points_summed(), 1400);
}

TEST(Analytic, RefusesShapesThatAreNone) {
  EXPECT_THROW(SphereField(0), Error);
  EXPECT_THROW(SphereField(std::nan("")), Error);
  EXPECT_THROW(BoxField({1, -1, 1}), Error);
  EXPECT_THROW(TorusField(1, 2), Error);
  EXPECT_THROW(PlaneField({.step_length = 0}), Error);
  EXPECT_THROW(PlaneField({.resolution = -1}), Error);
  EXPECT_THROW(UnionField({}), Error);
  EXPECT_THROW(UnionField({nullptr}), Error);
}

}  // namespace
}  // namespace palpate
