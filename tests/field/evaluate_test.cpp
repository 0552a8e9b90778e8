#include "field/evaluate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "field/formulas.hpp"
#include "palpate/base/error.hpp"
#include "support/known_edges.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::draw_edges;
using test::make_points;
using test::TestPoint;
using test::wavy_sheet;

/// A surface of one or two sources with everything uneven.
struct Case {
  FieldOptions options;
  int sources = 1;
  double doubtful = 0;  // share of points without trusted normals
  const char* name = "";
  int sharp = 0;  // sources that know of edges, as bits
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class GradientTest : public testing::TestWithParam<Case> {
 protected:
  GradientTest() {
    for (int s = 0; s < GetParam().sources; ++s) {
      points_[s] = make_points(wavy_sheet(10 + s, GetParam().doubtful), GetParam().options.kernel);
      if ((GetParam().sharp >> s & 1) != 0) draw_edges(points_[s], static_cast<unsigned>(s));
      layers_.push_back({&points_[s], s});
    }
    for (Patch* patch : {&above_, &below_}) {
      const Stance stance{patch == &above_ ? Vector3d(0, 0, 9e-3) : Vector3d(0, 0, -9e-3)};
      patch->gather(layers_, GetParam().sources, Vector3d::Zero(), 20e-3,
                    {.raw_weights = GetParam().options.raw_weights, .stance = &stance});
    }
  }

  std::array<SurfacePoints, 2> points_;
  std::vector<ActiveLayer> layers_;
  Patch above_{2048};  // seen from there
  Patch below_{2048};
};

TEST_P(GradientTest, IsTheDerivativeOfTheValue) {
  const ImplicitSurface surface(GetParam().options);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  constexpr double h = 2e-8;
  for (int k = 0; k < 400; ++k) {
    const Vector3d x(12e-3 * place(random), 12e-3 * place(random), 8e-3 * place(random));
    const Patch& patch = k % 2 == 0 ? above_ : below_;
    const Sample sample = evaluate(surface, patch, x);
    Vector3d numeric;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = h * Vector3d::Unit(axis);
      numeric[axis] =
          (evaluate(surface, patch, x + step).value - evaluate(surface, patch, x - step).value) /
          (2 * h);
    }
    EXPECT_LE((sample.gradient - numeric).norm(), 1e-5 * numeric.norm()) << "at " << x.transpose();
  }
}

// Second derivatives jump where cap and blend set in, so h stays far below those widths.
INSTANTIATE_TEST_SUITE_P(
    All, GradientTest,
    testing::Values(
        Case{{}, 1, 0, "balanced"}, Case{{}, 2, 0, "balanced_two_sources"},
        Case{{}, 1, 0.6, "balanced_blended"}, Case{{}, 2, 0.6, "balanced_blended_two_sources"},
        Case{{.kernel = Kernel::wendland}, 1, 0.3, "balanced_wendland"},
        Case{{.tool_radius = 2e-3}, 1, 0.5, "balanced_tool"}, Case{{}, 1, 0, "sharp", 1},
        Case{{.kernel = Kernel::wendland, .tool_radius = 2e-3}, 1, 0.5, "sharp_wendland_tool", 1},
        Case{{}, 2, 0.3, "sharp_two_sources", 3}, Case{{}, 2, 0.3, "one_of_two_sharp", 2},
        Case{{.kind = FieldOptions::Kind::pointset}, 1, 0, "pointset"},
        Case{{.kind = FieldOptions::Kind::pointset}, 2, 0.6, "pointset_blended"},
        Case{{.kind = FieldOptions::Kind::metaball}, 1, 0, "metaball"},
        Case{{.kind = FieldOptions::Kind::metaball, .kernel = Kernel::wendland},
             2,
             0,
             "metaball_wendland"},
        Case{{.kind = FieldOptions::Kind::metaball, .tool_radius = 2e-3}, 2, 0, "metaball_tool"},
        Case{{.kind = FieldOptions::Kind::metaball, .tool_radius = 3.5e-3},
             2,
             0,
             "metaball_large_tool"},
        Case{{.kind = FieldOptions::Kind::metaball, .threshold = 0.5, .raw_weights = true},
             1,
             0,
             "raw"}),
    [](const auto& test) { return test.param.name; });

TEST_P(GradientTest, EveryInstructionSetGivesTheSameBits) {
  if (&simd::best_sums() == &simd::kSumsBaseline)
    GTEST_SKIP() << "this processor has one level only";
  ImplicitSurface plain(GetParam().options);
  ImplicitSurface wide(GetParam().options);
  plain.sums = &simd::kSumsBaseline;
  wide.sums = &simd::kSumsV3;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-15e-3, 15e-3);
  for (int k = 0; k < 300; ++k) {
    const Vector3d x(place(random), place(random), place(random));
    const Sample a = evaluate(plain, above_, x);
    const Sample b = evaluate(wide, above_, x);
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.gradient, b.gradient);
    const Ball ball{x, 2e-3};
    EXPECT_EQ(is_free(plain, above_, ball), is_free(wide, above_, ball));
  }
}

std::vector<TestPoint> plane_points(double spacing, double radius, int half = 15) {
  std::vector<TestPoint> points;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      points.push_back({{spacing * i, spacing * j, 0}, Vector3d::UnitZ(), radius, 1});
    }
  }
  return points;
}

/// Around the origin, seen from above or from below.
Patch patch_of(const SurfacePoints& points, double side = 1) {
  Patch patch(4096);
  const Stance stance{Vector3d(0, 0, 9e-3 * side)};
  patch.gather(std::vector<ActiveLayer>{{&points}}, 1, Vector3d::Zero(), 10e-3,
               {.stance = &stance});
  return patch;
}

TEST(Evaluate, HeightOverAPlaneIsExact) {
  const SurfacePoints points = make_points(plane_points(4e-3, 10e-3));
  const Patch patch = patch_of(points);
  const Patch from_below = patch_of(points, -1);
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset}) {
    const ImplicitSurface surface{FieldOptions{.kind = kind}};
    for (const double z : {-3e-3, -1e-3, 0.0, 1e-3, 3e-3}) {
      const Sample sample = evaluate(surface, patch, {0.3e-3, 0.2e-3, z});
      EXPECT_NEAR(sample.value, z, 1e-12);
      EXPECT_LT((sample.gradient - Vector3d::UnitZ()).norm(), 1e-9);
      EXPECT_NEAR(evaluate(surface, from_below, {0.3e-3, 0.2e-3, z}).value, -z, 1e-12);
    }
  }
}

TEST(Evaluate, AToolPushesThePlaneOutByItsRadius) {
  const SurfacePoints points = make_points(plane_points(4e-3, 10e-3));
  const Patch patch = patch_of(points);
  const ImplicitSurface ball{FieldOptions{.tool_radius = 3e-3}};
  EXPECT_NEAR(evaluate(ball, patch, {0, 0, 3e-3}).value, 0, 1e-12);
  EXPECT_NEAR(evaluate(ball, patch_of(points, -1), {0, 0, -3e-3}).value, 0, 1e-12);

  const ImplicitSurface blob{
      FieldOptions{.kind = FieldOptions::Kind::metaball, .tool_radius = 3e-3}};
  double low = 0;
  double high = 10e-3;
  for (int i = 0; i < 50; ++i) {
    const double z = 0.5 * (low + high);
    (evaluate(blob, patch, {0, 0, z}).value < 0 ? low : high) = z;
  }
  EXPECT_NEAR(low, 4.9e-3 + 3e-3, 0.3e-3);
}

TEST(Evaluate, CapEndsTheSurfaceBehindTheLastRow) {
  auto points = plane_points(4e-3, 10e-3);
  std::erase_if(points, [](const TestPoint& p) { return p.position.x() > 0; });
  const SurfacePoints half = make_points(points);
  const ImplicitSurface surface{FieldOptions{}};
  const Patch patch = patch_of(half);
  EXPECT_LT(evaluate(surface, patch, {-2e-3, 0, -1e-3}).value, 0);
  EXPECT_GT(evaluate(surface, patch, {6e-3, 0, -1e-3}).value, 0);  // naive: still "solid"
}

TEST(Evaluate, FourSourcesThatAgreeRaiseAMetaballByLittle) {
  const SurfacePoints points = make_points(plane_points(2e-3, 10e-3));
  const auto height_of_surface = [&](int sources) {
    std::vector<ActiveLayer> layers;
    for (int s = 0; s < sources; ++s) layers.push_back({&points, s});
    Patch patch(8192);
    patch.gather(layers, sources, Vector3d::Zero(), 12e-3);
    const ImplicitSurface surface{FieldOptions{.kind = FieldOptions::Kind::metaball}};
    double low = 0;
    double high = 10e-3;
    for (int i = 0; i < 50; ++i) {
      const double z = 0.5 * (low + high);
      (evaluate(surface, patch, {0, 0, z}).value < 0 ? low : high) = z;
    }
    return low;
  };
  const double one = height_of_surface(1);
  EXPECT_GT(height_of_surface(4), one);
  // 4^(1/4) times the weight: as if the level were 0.4 / 4^(1/4).
  const double rise =
      plane_offset(Kernel::wyvill, 0.4 / std::sqrt(2.0)) - plane_offset(Kernel::wyvill, 0.4);
  EXPECT_NEAR(height_of_surface(4) - one, rise * 10e-3, 0.02e-3);
  EXPECT_LT(rise, 0.0725);
}

TEST(Evaluate, PrintedGradientPointsInwards) {
  const SurfacePoints points = make_points(wavy_sheet(20));
  const Patch patch = patch_of(points);
  FieldOptions options{.kind = FieldOptions::Kind::metaball};
  const ImplicitSurface exact(options);
  options.gradient = FieldOptions::Gradient::printed;
  const ImplicitSurface printed(options);
  int inward = 0;
  int counted = 0;
  for (double x = -8e-3; x < 8e-3; x += 1.1e-3) {
    for (double y = -8e-3; y < 8e-3; y += 1.1e-3, ++counted) {
      const Vector3d place(x, y, 5e-3);
      const Vector3d right = evaluate(exact, patch, place).gradient;
      if (evaluate(printed, patch, place).gradient.dot(right) < 0) ++inward;
    }
  }
  EXPECT_GT(inward, 0.9 * counted);
}

TEST(Evaluate, DegenerateNeighbourhoodsStayFinite) {
  const std::vector<std::vector<TestPoint>> clouds = {
      {{{0, 0, 0}, Vector3d::Zero(), 10e-3, 0}},
      {{{0, 0, 0}, Vector3d::UnitZ(), 10e-3, 1}, {{0, 0, 0}, -Vector3d::UnitZ(), 10e-3, 1}},
      {{{0, 0, 0}, Vector3d::UnitX(), 10e-3, 1}}};
  for (const auto& cloud : clouds) {
    SurfacePoints points = make_points(cloud);
    draw_edges(points, 1);
    const Patch patch = patch_of(points);
    for (const FieldOptions::Kind kind :
         {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset,
          FieldOptions::Kind::metaball}) {
      const ImplicitSurface surface{FieldOptions{.kind = kind}};
      for (const double z : {0.0, 1e-12, 5e-3, 9.999999e-3, 10e-3, 11e-3}) {
        const Sample sample = evaluate(surface, patch, {0, 0, z});
        EXPECT_TRUE(std::isfinite(sample.value) && sample.gradient.allFinite());
        EXPECT_TRUE(std::isfinite(sample.radius));
      }
    }
  }
}

TEST(Evaluate, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(ImplicitSurface(FieldOptions{.threshold = 0}), Error);
  EXPECT_THROW(ImplicitSurface(FieldOptions{.threshold = 1.5}), Error);
  EXPECT_NO_THROW(ImplicitSurface(FieldOptions{.threshold = 1.5, .raw_weights = true}));
  EXPECT_THROW(ImplicitSurface(FieldOptions{.minimum_support = 1}), Error);
  EXPECT_THROW(ImplicitSurface(FieldOptions{.tool_radius = -1}), Error);
  EXPECT_THROW(ImplicitSurface(FieldOptions{.tool_radius = 1e-3, .raw_weights = true}), Error);
}

}  // namespace
}  // namespace palpate
