// Two sheets that run together, as the faces of a blade do and two scans that cross each other.
#include <gtest/gtest.h>

#include "field/edged_shapes.hpp"
#include "field/evaluate.hpp"
#include "field/patch.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kThinSupport = 5e-3;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// A sheet in z = 0 and another that leaves it below from the y axis on, for x > 0; their normals
/// face away from each other, and they are seen from above.
class RunningTogether {
 public:
  /// `tilt`: of normals, rad.
  explicit RunningTogether(double degrees, double tilt = 0) {
    const Sampling sampling{.spacing = 2e-3, .radius = kThinSupport, .tilt = tilt};
    std::vector<TestPoint> all = sheet(sampling, 24e-3);
    const std::size_t upper = all.size();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.rotate(Eigen::AngleAxisd(radians(degrees), Vector3d::UnitY()));
    for (TestPoint p : sheet(sampling, {1e-3, -24e-3}, {24e-3, 24e-3}, T)) {
      p.normal = -p.normal;
      all.push_back(p);
    }
    points_ = make_points(all);
    points_.segments = {{}, {0, 0}, {0}, std::vector<float>(all.size(), 0.f)};
    for (const std::uint32_t i : points_.grid.order()) {
      points_.segments.segment.push_back(i < upper ? 0 : 1);
    }
    const Stance stance{{2e-3, 0, 0.5 * kThinSupport}};
    patch_.gather(std::vector<ActiveLayer>{{&points_}}, 1, Vector3d::Zero(), 30e-3,
                  {.stance = &stance});
  }

  [[nodiscard]] Sample sample(const Vector3d& x, FieldOptions::Kind kind) const {
    return evaluate(ImplicitSurface({.kind = kind}), patch_, x);
  }

 private:
  SurfacePoints points_;
  Patch patch_{16384};
};

TEST(ThinPlate, HasNoHoleWhereItsSidesRunTogether) {
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset}) {
    for (const double degrees : {1., 3., 6., 10., 15.}) {
      const RunningTogether plate(degrees);
      for (double x = -15e-3; x <= 15e-3; x += 0.5e-3) {
        EXPECT_GT(plate.sample({x, 0, 0.2 * kThinSupport}, kind).value, 0) << degrees << ", " << x;
        EXPECT_LT(plate.sample({x, 0, -0.08 * kThinSupport}, kind).value, 0)
            << degrees << ", " << x;
      }
    }
  }
}

TEST(ThinPlate, EndsWhereItsFarSideIs) {
  const RunningTogether plate(10);
  for (double x = 8e-3; x <= 15e-3; x += 0.5e-3) {  // thicker than 0.2 R
    const double thick = x * std::tan(radians(10));
    EXPECT_LT(plate.sample({x, 0, 0.1e-3 - thick}, FieldOptions::Kind::balanced).value, 0) << x;
    EXPECT_GT(plate.sample({x, 0, -0.1e-3 - thick}, FieldOptions::Kind::balanced).value, 0) << x;
  }
}

TEST(ThinPlate, TheGradientIsExact) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  constexpr double kStep = 2e-8;
  for (const double degrees : {5., 15., 25.}) {
    const RunningTogether plate(degrees, 0.1);
    for (int k = 0; k < 400; ++k) {
      const Vector3d x = Vector3d(6e-3, 6e-3, 1e-3)
                             .cwiseProduct(Vector3d(place(random), place(random), place(random)));
      const Sample sample = plate.sample(x, FieldOptions::Kind::balanced);
      Vector3d numeric;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = kStep * Vector3d::Unit(axis);
        numeric[axis] = (plate.sample(x + step, FieldOptions::Kind::balanced).value -
                         plate.sample(x - step, FieldOptions::Kind::balanced).value) /
                        (2 * kStep);
      }
      EXPECT_LE((sample.gradient - numeric).norm(), 2e-5 * std::max(1.0, numeric.norm()))
          << degrees << " at " << x.transpose();
    }
  }
}

}  // namespace
}  // namespace palpate::test
