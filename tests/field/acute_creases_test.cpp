// Creases that are narrower than a support can tell apart, without a proxy.
#include <gtest/gtest.h>

#include <numbers>

#include "field/edged_shapes.hpp"
#include "field/evaluate.hpp"
#include "field/oriented.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// Points and their patch around the origin.
class Gathered {
 public:
  /// `stance`: where they are seen from; nullptr: as their normals say.
  explicit Gathered(const std::vector<TestPoint>& points, const Stance* stance = nullptr)
      : points_(make_points(points)) {
    patch_.gather(std::vector<ActiveLayer>{{&points_}}, 1, Vector3d::Zero(), 30e-3,
                  {.stance = stance});
  }

  [[nodiscard]] double closure(const Vector3d& x) const {
    simd::Sums sums;
    surface_.sums->all(patch_.columns(), false, x.data(), sums);
    if (!(sums.label[kNearFace].v > 0)) return 0;
    const Value radius{sums.wr / sums.w[0], Vector3d::Zero()};
    return crease_closure({.functions = surface_.sums,
                           .columns = &patch_.columns(),
                           .x = x.data(),
                           .all = &sums,
                           .radius = radius})
        .f;
  }

  [[nodiscard]] Sample sample(const Vector3d& x, const FieldOptions& options) const {
    return evaluate(ImplicitSurface(options), patch_, x);
  }

 private:
  SurfacePoints points_;
  Patch patch_{16384};
  ImplicitSurface surface_{FieldOptions{}};
};

constexpr double kCreaseSupport = 8e-3;

/// The place in the middle of a wedge, so far from where its sheets meet.
Vector3d crease_middle(double angle, double out) {
  return {out * std::cos(angle / 2), 0.3e-3, out * std::sin(angle / 2)};
}

TEST(AcuteCreases, AreClosedTheMoreTheNarrower) {
  double last = 0;
  for (const double degrees : {85.0, 75.0, 60.0, 45.0, 30.0, 15.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Gathered points(wedge(fine(kCreaseSupport), angle, 24e-3));
    const double closure = points.closure(crease_middle(angle, 0.5 * kCreaseSupport));
    EXPECT_GT(closure, last) << degrees;
    EXPECT_LE(closure, 0.2 * kCreaseSupport) << degrees;
    last = closure;
  }
  EXPECT_GT(last, 0.15 * kCreaseSupport);
}

TEST(AcuteCreases, NothingElseIsTouched) {
  const double wide = 2 * std::numbers::pi / 3;
  const struct {
    const char* name;
    std::vector<TestPoint> points;
  } shapes[] = {{"plane", sheet(fine(kCreaseSupport), 24e-3)},
                {"plate", plate(fine(kCreaseSupport), 24e-3, 1e-3)},
                {"box", box(fine(kCreaseSupport), {16e-3, 16e-3, 2e-3})},
                {"ridge", ridge(fine(kCreaseSupport), 24e-3)},
                {"wide crease", wedge(fine(kCreaseSupport), wide, 24e-3)},
                {"ball", ball(fine(kCreaseSupport), 12e-3)}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-12e-3, 12e-3);
  for (const auto& shape : shapes) {
    const Gathered points(shape.points);
    for (int k = 0; k < 300; ++k) {
      const Vector3d x(place(random), place(random), place(random));
      EXPECT_EQ(points.closure(x), 0) << shape.name << " at " << x.transpose();
    }
  }
}

TEST(AcuteCreases, FromTheirOtherSideTheyAreEdgesAndStay) {
  const double angle = std::numbers::pi / 6;
  const Stance below{Vector3d(12e-3, 0, -6e-3)};
  const Gathered points(wedge(fine(kCreaseSupport), angle, 24e-3), &below);
  for (double out = 0; out < 2 * kCreaseSupport; out += 0.25e-3) {
    EXPECT_EQ(points.closure(crease_middle(angle, out)), 0) << out;
  }
}

TEST(AcuteCreases, BehindEitherSheetIsSolid) {
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset}) {
    for (double degrees = 15; degrees <= 90; degrees += 5) {
      const double angle = degrees * std::numbers::pi / 180;
      const Gathered points(wedge(fine(kCreaseSupport), angle, 24e-3));
      const Vector3d behind_wall(-std::sin(angle), 0, std::cos(angle));
      for (double along = 0; along < 2 * kCreaseSupport; along += 0.5e-3) {
        const Vector3d floor(along, 0.3e-3, -0.2 * kCreaseSupport);
        const Vector3d wall = Vector3d(along * std::cos(angle), 0.3e-3, along * std::sin(angle)) +
                              0.2 * kCreaseSupport * behind_wall;
        EXPECT_LT(points.sample(floor, {.kind = kind}).value, 0) << degrees << ", " << along;
        EXPECT_LT(points.sample(wall, {.kind = kind}).value, 0) << degrees << ", " << along;
      }
    }
  }
}

TEST(AcuteCreases, TheGradientIsExact) {
  Sampling rough = fine(kCreaseSupport);
  rough.jitter = 0.2;
  rough.noise = 0.05;
  rough.tilt = 0.05;
  auto shape = wedge(rough, std::numbers::pi / 5, 24e-3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.6, 1);
  for (TestPoint& p : shape) {
    p.radius *= uniform(random);
    p.confidence = uniform(random);
  }
  const Gathered points(shape);
  std::uniform_real_distribution<double> place(-6e-3, 6e-3);
  constexpr double kStep = 2e-8;
  int closed = 0;
  for (int k = 0; k < 400; ++k) {
    const Vector3d x(place(random) + 4e-3, place(random), 0.5 * place(random) + 1e-3);
    for (const FieldOptions::Kind kind :
         {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset}) {
      const FieldOptions options{.kind = kind};
      const Sample sample = points.sample(x, options);
      Vector3d numeric;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = kStep * Vector3d::Unit(axis);
        numeric[axis] =
            (points.sample(x + step, options).value - points.sample(x - step, options).value) /
            (2 * kStep);
      }
      EXPECT_LE((sample.gradient - numeric).norm(), 2e-5 * std::max(1.0, numeric.norm()))
          << x.transpose();
    }
    if (points.closure(x) > 1e-5) ++closed;
  }
  EXPECT_GT(closed, 100);
}

}  // namespace
}  // namespace palpate::test
