#include "field/facing.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "field/evaluate.hpp"
#include "field/patch.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Puts all points on the first of these segments, whose components have no known side.
void put_on_segments(SurfacePoints& points, std::vector<std::uint32_t> components) {
  points.segments = {.segment = std::vector<std::uint32_t>(points.size(), 0),
                     .component = std::move(components),
                     .known = {0},
                     .residual = std::vector<float>(points.size(), 0)};
}

/// A plane at the height z as preparation makes it, m: one segment, whose normals point this way.
std::unique_ptr<SurfacePoints> sheet_at(double z, double sign) {
  std::vector<test::TestPoint> plane;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      plane.push_back({{2e-3 * i, 2e-3 * j, z}, sign * Vector3d::UnitZ(), 5e-3, 1});
    }
  }
  auto points = std::make_unique<SurfacePoints>(test::make_points(plane));
  put_on_segments(*points, {0});
  return points;
}

TEST(Facing, ASurfaceThatRisesFromCloudToCloudKeepsItsSide) {
  Patch patch(2048);
  std::vector<std::unique_ptr<SurfacePoints>> clouds;
  for (int k = 0; k < 60; ++k) {
    const double z = 0.5e-3 * k;  // a tenth of R a cloud
    clouds.push_back(sheet_at(z, k % 2 == 0 ? 1 : -1));
    // Free and above the first; on all that follow.
    const Stance stance{{0, 0, k == 0 ? 4e-3 : z}, {0, 0, k == 0 ? 0. : 1.}};
    patch.gather(std::vector<ActiveLayer>{{.points = clouds.back().get()}}, 1, {0, 0, z}, 2e-3,
                 {.stance = &stance});
    ASSERT_GT(patch.points(), 10u);
    for (std::uint32_t i = 0; i < patch.columns().end(); ++i) {
      ASSERT_GE(patch.columns().normal[2][i], 0) << k;  // 0: a point that fills a run up
    }
  }
}

TEST(Facing, WhatDoesNotKnowItsSideStaysAbsentForAHandThatCameFromBehind) {
  std::unique_ptr<SurfacePoints> seen = sheet_at(0, 1);
  seen->eye.emplace(SurfaceEye{{0, 0, 1}, {}});
  seen->segments.component = {0, 1};
  seen->segments.known = {1, 0};
  for (std::size_t i = 0; i < seen->size(); ++i) {
    seen->segments.segment[i] =
        seen->grid.points()[i].x() > 0 ? 1 : 0;  // 1: of a side nobody knows
  }
  const std::vector<ActiveLayer> layers = {{.points = seen.get()}};
  Patch patch(2048);
  const auto stand = [&](double x, double z) {
    const Stance stance{{x, 0, z}, Vector3d::Zero()};
    patch.gather(layers, 1, stance.proxy, 1e-3, {.stance = &stance});
    ASSERT_GT(patch.points(), 10u);
  };
  stand(-15e-3, -2e-3);
  EXPECT_TRUE(patch.sides().is_behind());
  stand(0, -2e-3);
  stand(15e-3, -2e-3);  // no other points in reach
  EXPECT_TRUE(patch.sides().is_behind());
  stand(15e-3, 2e-3);
  EXPECT_TRUE(patch.sides().is_behind());
  stand(0, 4e-3);
  EXPECT_FALSE(patch.sides().is_behind());
  stand(15e-3, 2e-3);
  EXPECT_FALSE(patch.sides().is_behind());
}

/// How much of the normals in the patch points along z, as they are turned.
double turned_up(const Patch& patch) {
  double sum = 0;
  for (std::uint32_t i = 0; i < patch.columns().end(); ++i) sum += patch.columns().normal[2][i];
  return sum;
}

TEST(Facing, NormalsThatAreWrongTurnNobodyOver) {
  std::unique_ptr<SurfacePoints> plane = sheet_at(0, 1);
  for (std::size_t i = 0; i < plane->size(); ++i) {  // 30 degrees too far out
    const Eigen::Vector3f out = plane->grid.points()[i] + plane->origin.cast<float>();
    plane->normals[i] = (0.866F * Eigen::Vector3f::UnitZ() + 0.5F * out.normalized()).normalized();
  }
  const std::vector<ActiveLayer> layers = {{.points = plane.get()}};
  const auto come_down_from = [&](double height) {
    Patch patch(2048);
    for (double z = height; z > 0.5e-3; z -= 0.75e-3) {
      patch.sides().reopen();
      const Stance stance{{0, 0, z}, Vector3d::Zero()};
      patch.gather(layers, 1, stance.proxy, 1e-3, {.stance = &stance});
    }
    return turned_up(patch);
  };
  // The planes of most points are higher than the eye; their surface is not.
  EXPECT_GT(come_down_from(0.75e-3), 0);
  EXPECT_GT(come_down_from(4.5e-3), 0);
}

TEST(Facing, AProxyThatWentAroundAnEdgeSeesTheOtherSide) {
  const std::unique_ptr<SurfacePoints> plane = sheet_at(0, 1);
  const std::vector<ActiveLayer> layers = {{.points = plane.get()}};
  Patch patch(2048);
  const auto go = [&](double x, double z) {
    patch.sides().reopen();
    const Stance stance{{x, 0, z}, Vector3d::Zero()};
    patch.gather(layers, 1, stance.proxy, 1e-3, {.stance = &stance});
  };
  for (double x = 15e-3; x < 23e-3; x += 1e-3) go(x, 3e-3);
  EXPECT_GT(turned_up(patch), 0);
  for (double z = 3e-3; z > -3e-3; z -= 1e-3) go(23e-3, z);
  for (double x = 23e-3; x > 20e-3; x -= 1e-3) go(x, -3e-3);
  EXPECT_LT(turned_up(patch), 0);
}

// The other parts of a tool are above it: a part that looks from below is where they are.
TEST(Facing, WhatPartsOfAToolAgreeOnStandsAboveWhatOneSees) {
  AgreedSides agreed;
  const std::unique_ptr<SurfacePoints> sheet = sheet_at(0, 1);
  const auto up = [&](const Vector3d& from, AgreedSides* with) {
    Patch patch(2048);
    const Stance stance{from, Vector3d::Zero(), 0, with};
    patch.gather(std::vector<ActiveLayer>{{.points = sheet.get()}}, 1, {0, 0, 0}, 2e-3,
                 {.stance = &stance});
    return patch.columns().normal[2][0];
  };
  EXPECT_GT(up({0, 0, 4e-3}, &agreed), 0);
  EXPECT_LT(up({0, 0, -4e-3}, nullptr), 0);
  EXPECT_GT(up({0, 0, -4e-3}, &agreed), 0);
  agreed.begin_update(0.9 * AgreedSides::kKept);
  EXPECT_GT(up({0, 0, -4e-3}, &agreed), 0);  // which confirms it
  agreed.begin_update(0.9 * AgreedSides::kKept);
  EXPECT_GT(up({0, 0, -4e-3}, &agreed), 0);
  agreed.begin_update(1.1 * AgreedSides::kKept);
  EXPECT_LT(up({0, 0, -4e-3}, &agreed), 0);
  EXPECT_LT(up({0, 0, 4e-3}, &agreed), 0);
}

TEST(Facing, WhatAToolBeginsToTouchTurnsItsFlanksOutward) {
  std::vector<test::TestPoint> flanks;  // of a wall 3 mm thick, whose rim has no normals
  for (int j = -10; j <= 10; ++j) {
    for (int k = 1; k <= 8; ++k) {
      for (const double side : {-1., 1.}) {
        flanks.push_back({{1.5e-3 * side, 2e-3 * j, -2e-3 * k}, side * Vector3d::UnitX(), 5e-3, 1});
      }
    }
  }
  SurfacePoints points = test::make_points(flanks);
  put_on_segments(points, {0, 0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.segments.segment[i] = points.normals[i].x() > 0 ? 1 : 0;
  }
  Patch patch(2048);
  const auto outward = [&](const Stance& stance) {
    patch.gather(std::vector<ActiveLayer>{{.points = &points}}, 1, stance.proxy, 1e-3,
                 {.stance = &stance});
    double sum = 0;
    for (std::uint32_t i = 0; i < patch.columns().end(); ++i) {
      sum += patch.columns().normal[0][i] * patch.columns().position[0][i];
    }
    return sum;
  };
  EXPECT_LT(outward({{0, 0, 1e-3}, Vector3d::Zero()}), 0);  // seen from between their planes
  EXPECT_GT(outward({{0, 0, 0.5e-3}, Vector3d::UnitZ()}), 0);
}

/// A face in z = 0 as far as x = `end`, and beneath it a wall in x = 0 that faces along x; m.
std::unique_ptr<SurfacePoints> face_over_wall(double end) {
  std::vector<test::TestPoint> all;
  for (int j = -10; j <= 10; ++j) {
    for (int i = -10; 2e-3 * i <= end + 1e-9; ++i) {
      all.push_back({{2e-3 * i, 2e-3 * j, 0}, Vector3d::UnitZ(), 5e-3, 1});
    }
    for (int i = 1; i <= 8; ++i) {
      all.push_back({{0, 2e-3 * j, -2e-3 * i}, Vector3d::UnitX(), 5e-3, 1});
    }
  }
  auto points = std::make_unique<SurfacePoints>(test::make_points(all));
  put_on_segments(*points, {0, 0});
  for (std::size_t i = 0; i < points->size(); ++i) {
    points->segments.segment[i] = points->grid.points()[i].z() < -1e-3F ? 1 : 0;
  }
  return points;
}

/// Is it free 1 mm under the face and 2 mm before the wall, for a hand that comes from above?
bool is_free_before_the_wall(double end) {
  const std::unique_ptr<SurfacePoints> points = face_over_wall(end);
  Patch patch(2048);
  const Stance stance{{1e-3, 0, 3e-3}, Vector3d::Zero()};
  patch.gather(std::vector<ActiveLayer>{{.points = points.get()}}, 1, {1e-3, 0, 0}, 4e-3,
               {.stance = &stance});
  return evaluate(ImplicitSurface(FieldOptions{}), patch, {2e-3, 0, -1e-3}).value > 0;
}

/// The field in the middle between two scans of one plane, `gap` apart (m), for a hand above them.
double between_scans(double gap) {
  std::vector<test::TestPoint> all;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      all.push_back({{2e-3 * i, 2e-3 * j, 0}, Vector3d::UnitZ(), 5e-3, 1});
      all.push_back({{2e-3 * i, 2e-3 * j, -gap}, Vector3d::UnitZ(), 5e-3, 1});
    }
  }
  SurfacePoints points = test::make_points(all);
  put_on_segments(points, {0, 0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.segments.segment[i] = points.grid.points()[i].z() < -0.5 * gap ? 1 : 0;
  }
  Patch patch(2048);
  const Stance stance{{0, 0, 3e-3}, Vector3d::Zero()};
  patch.gather(std::vector<ActiveLayer>{{.points = &points}}, 1, Vector3d::Zero(), 4e-3,
               {.stance = &stance});
  return evaluate(ImplicitSurface(FieldOptions{}), patch, {0, 0, -0.5 * gap}).value;
}

// The nearest of two scans, or the farthest, would be half a gap away there.
TEST(Facing, TwoScansOfOnePlaneAreFeltInTheirMean) {
  for (const double gap : {0.5e-3, 0.75e-3, 0.9e-3, 1e-3, 1.25e-3}) {  // R is 5 mm
    EXPECT_NEAR(between_scans(gap), 0, 0.1 * gap) << gap;
  }
}

TEST(Facing, AWallUnderAFaceCutsNothingOffIt) {
  EXPECT_FALSE(is_free_before_the_wall(20e-3));
}

TEST(Facing, AFaceEndsAtTheEdgeWhereAWallBegins) {
  EXPECT_TRUE(is_free_before_the_wall(0));
}

}  // namespace
}  // namespace palpate
