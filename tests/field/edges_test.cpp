// Edges and creases of points that know what they meet, without a proxy.
#include <gtest/gtest.h>

#include <numbers>

#include "field/edged_shapes.hpp"
#include "field/evaluate.hpp"
#include "field/oriented.hpp"
#include "support/known_edges.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const Vector3d kOutside(5e-3, 0, 6e-3);

/// Points, their patch around the origin, and the surfaces with and without sharp edges.
class Pair {
 public:
  explicit Pair(const std::vector<TestPoint>& points, const Vector3d& seen_from = kOutside)
      : points_(make_points(points)) {
    tell_edges(points_);
    const Stance stance{seen_from};
    patch_.gather(std::vector<ActiveLayer>{{&points_}}, 1, Vector3d::Zero(), 20e-3,
                  {.stance = &stance});
  }

  [[nodiscard]] Sample sharp(const Vector3d& x) const { return evaluate(sharp_, patch_, x); }
  [[nodiscard]] Sample mean(const Vector3d& x) const { return evaluate(mean_, patch_, x); }

 private:
  SurfacePoints points_;
  Patch patch_{16384};
  ImplicitSurface sharp_{FieldOptions{}};
  ImplicitSurface mean_{FieldOptions{.sharp_edges = false}};
};

/// How far a ridge's surface stands out of the true one on a ray that leaves the solid, m.
template <class Sampler>
double standing_out(const Sampler& sample, double angle) {
  const Vector3d from(-6e-3, 0.3e-3, -6e-3);
  const Vector3d way(std::cos(angle), 0, std::sin(angle));
  const double truth = 6e-3 / std::max(way.x(), way.z());
  double solid = truth + 6e-3;
  while (solid > 0 && sample(from + solid * way).value > 0) solid -= 1e-5;
  return solid - truth;
}

class Ridge : public testing::TestWithParam<double> {};

TEST_P(Ridge, KeepsItsShape) {
  const Pair pair(ridge(fine(GetParam()), 30e-3));
  double sharp = 0;
  double mean = 0;
  int rays = 0;
  for (double degrees = 5; degrees <= 85; degrees += 2, ++rays) {
    const double angle = degrees * std::numbers::pi / 180;
    sharp += std::abs(standing_out([&](const Vector3d& x) { return pair.sharp(x); }, angle));
    mean += std::abs(standing_out([&](const Vector3d& x) { return pair.mean(x); }, angle));
  }
  RecordProperty("sharp_um", std::to_string(1e6 * sharp / rays));
  RecordProperty("mean_um", std::to_string(1e6 * mean / rays));
  EXPECT_LT(sharp, 0.1 * mean);
  EXPECT_LT(sharp / rays, 0.01e-3);
}

INSTANTIATE_TEST_SUITE_P(Radii, Ridge, testing::Values(6e-3, 8e-3, 10e-3));

TEST(Edges, TheNormalsOfBothFacesLastUpToTheEdge) {
  const Pair pair(ridge(fine(10e-3), 30e-3));
  for (double d = 1e-3; d < 8e-3; d += 0.5e-3) {
    const Vector3d top = pair.sharp({-d, 0.3e-3, 0}).gradient.normalized();
    const Vector3d side = pair.sharp({0, 0.3e-3, -d}).gradient.normalized();
    EXPECT_GT(top.z(), std::cos(0.02)) << d;
    EXPECT_GT(side.x(), std::cos(0.02)) << d;
  }
  EXPECT_LT(pair.mean({-1e-3, 0.3e-3, 0}).gradient.normalized().z(), std::cos(0.3));
}

std::vector<TestPoint> rough_ridge() {
  Sampling sampling = fine();
  sampling.jitter = 0.2;
  sampling.noise = 0.05;
  sampling.tilt = 0.05;
  auto points = ridge(sampling, 30e-3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.6, 1);
  for (TestPoint& p : points) {
    p.radius *= uniform(random);
    p.confidence = uniform(random);
  }
  return points;
}

TEST(Edges, TheGradientIsExact) {
  const Pair pair(rough_ridge());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  constexpr double kStep = 2e-8;
  int sharpened = 0;
  for (int k = 0; k < 400; ++k) {
    const Vector3d x(4e-3 * place(random), 8e-3 * place(random), 4e-3 * place(random));
    const Sample sample = pair.sharp(x);
    Vector3d numeric;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kStep * Vector3d::Unit(axis);
      numeric[axis] = (pair.sharp(x + step).value - pair.sharp(x - step).value) / (2 * kStep);
    }
    EXPECT_LE((sample.gradient - numeric).norm(), 1e-5 * numeric.norm()) << x.transpose();
    if (std::abs(sample.value - pair.mean(x).value) > 1e-5) ++sharpened;
  }
  EXPECT_GT(sharpened, 100);
}

TEST(Edges, EveryInstructionSetGivesTheSameBits) {
  if (&simd::best_sums() == &simd::kSumsBaseline)
    GTEST_SKIP() << "this processor has one level only";
  SurfacePoints points = make_points(rough_ridge());
  tell_edges(points);
  Patch patch(16384);
  patch.gather(std::vector<ActiveLayer>{{&points}}, 1, Vector3d::Zero(), 10e-3);
  ImplicitSurface plain{FieldOptions{}};
  ImplicitSurface wide{FieldOptions{}};
  plain.sums = &simd::kSumsBaseline;
  wide.sums = &simd::kSumsV3;
  for (double a = -6e-3; a < 4e-3; a += 0.31e-3) {
    for (double b = -6e-3; b < 4e-3; b += 0.29e-3) {
      const Sample one = evaluate(plain, patch, {a, 0, b});
      const Sample other = evaluate(wide, patch, {a, 0, b});
      EXPECT_EQ(one.value, other.value);
      EXPECT_EQ(one.gradient, other.gradient);
    }
  }
}

void expect_same_edges(const Sample& a, const Sample& b, const Vector3d& x) {
  EXPECT_EQ(a.value, b.value) << x.transpose();
  EXPECT_EQ(a.gradient, b.gradient) << x.transpose();
}

TEST(Edges, PlanesAreWhatTheyWere) {
  const Pair flat(sheet(fine(), 30e-3));
  const Pair from_below(sheet(fine(), 30e-3), -kOutside);
  for (double a = -6e-3; a <= 8e-3; a += 0.9e-3) {
    for (double b = -6e-3; b <= 8e-3; b += 0.7e-3) {
      const Vector3d x(a, 0.4e-3, b);
      expect_same_edges(flat.sharp(x), flat.mean(x), x);
      expect_same_edges(from_below.sharp(x), from_below.mean(x), x);
    }
  }
}

// The wedge is free for x > 0 and z > 0: what is above both faces is, but for 1/50 of R in the
// foot.
TEST(Edges, CreasesAreSharp) {
  const Pair crease(wedge(fine(), std::numbers::pi / 2, 20e-3));
  for (double a = 0; a <= 2.5e-3; a += 0.3e-3) {
    for (double b = 0; b <= 2.5e-3; b += 0.2e-3) {
      EXPECT_NEAR(crease.sharp({a, 0.4e-3, b}).value, std::min(a, b), 0.02 * 8e-3);
    }
  }
  EXPECT_LT(crease.mean({1e-3, 0.4e-3, 1e-3}).value, 0.5e-3);
}

TEST(Edges, AreSeenFromTheOtherSideAsWell) {
  auto turned = ridge(fine(), 30e-3);
  for (TestPoint& p : turned) p.normal = -p.normal;
  const Pair seen_from_outside(ridge(fine(), 30e-3));
  const Pair seen_from_inside(ridge(fine(), 30e-3), {-5e-3, 0, -6e-3});
  const Pair turned_round(turned);
  int sharpened = 0;
  for (double a = -6e-3; a <= 4e-3; a += 0.9e-3) {
    for (double b = -6e-3; b <= 4e-3; b += 0.7e-3) {
      const Vector3d x(a, 0.4e-3, b);
      const Sample front = seen_from_outside.sharp(x);
      expect_same_edges(front, turned_round.sharp(x), x);
      if (front.value != seen_from_outside.mean(x).value) ++sharpened;
      if (std::max(a, b) > 1e-3 || std::min(a, b) < -2.5e-3) continue;
      EXPECT_NEAR(seen_from_inside.sharp(x).value, -std::max(a, b), 0.0126 * 8e-3);
    }
  }
  EXPECT_GT(sharpened, 50);
}

TEST(Edges, PointsThatDoNotAskForItAreLeftAlone) {
  const SurfacePoints plain = make_points(ridge(fine(), 30e-3));
  Patch patch(16384);
  patch.gather(std::vector<ActiveLayer>{{&plain}}, 1, Vector3d::Zero(), 20e-3);
  const Pair pair(ridge(fine(), 30e-3));
  const ImplicitSurface surface{FieldOptions{}};
  const Vector3d x(-1e-3, 0, -1e-3);
  EXPECT_EQ(evaluate(surface, patch, x).value, pair.mean(x).value);
  EXPECT_NE(evaluate(surface, patch, x).value, pair.sharp(x).value);
}

TEST(Edges, AHalfSharpSceneIsHalfSharp) {
  SurfacePoints sharp = make_points(ridge(fine(), 30e-3));
  const SurfacePoints plain = sharp;
  tell_edges(sharp);
  Patch patch(16384);
  patch.gather(std::vector<ActiveLayer>{{&sharp, 0, 0.25}, {&plain, 0, 0.75}}, 1, Vector3d::Zero(),
               10e-3);
  const Pair pair(ridge(fine(), 30e-3));
  const ImplicitSurface surface{FieldOptions{}};
  for (const Vector3d& x : {Vector3d(-1e-3, 0, -2e-3), Vector3d(-2e-3, 0, 0.5e-3)}) {
    const double expected = 0.75 * pair.mean(x).value + 0.25 * pair.sharp(x).value;
    EXPECT_NEAR(evaluate(surface, patch, x).value, expected, 1e-12);
  }
}

// Halfway, and far from the world's origin.
TEST(Edges, GoWithTheirPointsAndByAndBy) {
  const Eigen::Vector3f way(2e-3f, -1e-3f, 3e-3f);
  const Vector3d far(40, -30, 20);
  SurfacePoints points = make_points(ridge(fine(), 30e-3));
  tell_edges(points);
  points.origin = far;
  for (const Eigen::Vector3f& place : points.grid.points()) {
    points.end_positions.push_back(place + way);
  }
  points.edges.end = points.edges.start;
  for (SurfacePoints::EdgePlane& edge : points.edges.end) edge.share = 0;
  finish(points);
  check(points);
  Patch patch(16384);
  patch.gather(std::vector<ActiveLayer>{{.points = &points, .progress = 0.5}}, 1, far, 20e-3);
  const Pair still(ridge(fine(), 30e-3));
  const ImplicitSurface surface{FieldOptions{}};
  for (double a = -6e-3; a <= 4e-3; a += 0.9e-3) {
    for (double b = -6e-3; b <= 4e-3; b += 0.7e-3) {
      const Vector3d x(a, 0.4e-3, b);
      const double half = 0.5 * (still.mean(x).value + still.sharp(x).value);
      if (std::abs(half) > 2e-3) continue;  // the cap is not halved
      const Vector3d place = far + x + 0.5 * way.cast<double>();
      EXPECT_NEAR(evaluate(surface, patch, place).value, half, 1e-8) << x.transpose();
    }
  }
}

}  // namespace
}  // namespace palpate::test
