#include "scene/policies/edge_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "palpate/depth/depth_filter.hpp"
#include "scene/policies/morph.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::DepthOf;
using test::kFrame;

constexpr double kTilt = 35 * std::numbers::pi / 180;  // of both faces
constexpr double kNoise = 0.5e-3;                      // m

DepthOf leaning(double tilt, double at = 0) {
  return test::plane_depth({at, 0, 0.5}, {std::sin(tilt), 0, -std::cos(tilt)});
}
/// Two faces that meet in the line x = 0 at z = 0.5 m.
double roof(double x, double y) {
  return std::max(leaning(kTilt)(x, y), leaning(-kTilt)(x, y));
}
double valley(double x, double y) {
  return std::min(leaning(kTilt)(x, y), leaning(-kTilt)(x, y));
}
/// The roof, cut off 3.5 mm to each side of the line, which is less than R.
double blunt(double x, double y) {
  return std::max(roof(x, y), 0.5 + 3.5e-3 * std::tan(kTilt));
}
double flat(double, double) {
  return 0.5;
}

FilteredDepth filtered(const DepthOf& depth_of, double noise = kNoise, unsigned seed = 1) {
  DepthFilter filter({.memory = 1});
  return filter.filter(test::frame_of(test::small_camera(), 0, depth_of, noise, seed),
                       test::looking_down());
}

struct Found {
  FilteredDepth depth;
  BlockSurface surface{Kernel::wyvill};
  EdgeFinder finder;

  explicit Found(FilteredDepth given) : depth(std::move(given)) {
    surface.measure(depth);
    finder.look(depth, surface);
  }

  /// Calls visit(x, edge) for all blocks in the middle of the image with a fit.
  void each(const std::function<void(double, double, const EdgePlane&)>& visit) const {
    for (std::size_t b = 0; b < depth.size(); ++b) {
      const int row = static_cast<int>(b) / depth.columns;
      if (depth.states[b] != BlockState::fitted || row < 10 || row >= depth.rows - 10) continue;
      visit(depth.positions[b].x(), surface.radius(b), finder.edge(b));
    }
  }
  [[nodiscard]] int told() const {
    int count = 0;
    each([&](double, double, const EdgePlane& edge) { count += edge.share != 0 ? 1 : 0; });
    return count;
  }
};

class TwoFaces : public testing::TestWithParam<bool> {};

TEST_P(TwoFaces, AreToldToTheBlocksOfEachOther) {
  const bool convex = GetParam();
  const Found found(filtered(convex ? roof : valley));
  int near = 0;
  int told = 0;
  found.each([&](double x, double radius, const EdgePlane& edge) {
    if (std::abs(x) < 0.7 * radius * std::cos(kTilt)) ++near;
    if (edge.share == 0) return;
    if (std::abs(x) < 0.7 * radius * std::cos(kTilt)) ++told;
    EXPECT_EQ(edge.share, convex ? 1 : -1);
    EXPECT_LT(std::abs(x), radius) << "too far away to matter";
    if (std::abs(x) < 1.5e-3) return;  // which of the two faces a block on the line has
    // Of the other face: (sin, 0, -cos) of its tilt, through (0, 0, 0.5).
    const double tilt = (x > 0) == convex ? -kTilt : kTilt;
    const Vector3d normal(std::sin(tilt), 0, -std::cos(tilt));
    EXPECT_GT(edge.normal.cast<double>().dot(normal), std::cos(0.05)) << x;
    EXPECT_NEAR(edge.normal.z() * 0.5f - edge.offset, 0, 0.4e-3) << x;
  });
  EXPECT_GT(near, 100);
  EXPECT_GT(told, 0.9 * near);
}

INSTANTIATE_TEST_SUITE_P(Of, TwoFaces, testing::Bool());

TEST(EdgeFinder, FindsNothingWhereNoFacesMeet) {
  const auto ball = [](double x, double y) {
    const double a = x * x + y * y + 1;
    const double root = 0.45 * 0.45 - a * (0.45 * 0.45 - 0.05 * 0.05);
    return root > 0 ? (0.45 - std::sqrt(root)) / a : 0.5;
  };
  const auto step = [](double x, double) { return x < 0 ? 0.5 : 0.52; };
  const auto pole = [](double x, double) {
    const double a = x * x + 1;
    const double root = 0.45 * 0.45 - a * (0.45 * 0.45 - 0.02 * 0.02);
    return root > 0 ? (0.45 - std::sqrt(root)) / a : 0.6;
  };
  for (const DepthOf& depth_of : {DepthOf(flat), DepthOf(ball), DepthOf(step), DepthOf(pole)}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      EXPECT_EQ(Found(filtered(depth_of, kNoise, seed)).told(), 0);
    }
  }
}

TEST(EdgeFinder, AFaceNarrowerThanItsSupportIsNone) {
  EXPECT_EQ(Found(filtered(blunt, 0.1e-3)).told(), 0);
}

TEST(EdgeFinder, ToleratesAnyFrame) {
  for (const DepthOf& depth_of :
       {DepthOf([](double, double) { return 0.0; }),
        DepthOf([](double x, double y) { return std::fmod(1e3 * (x + y), 2.0); })}) {
    EXPECT_NO_THROW((void)Found(filtered(depth_of)).told());
  }
  EXPECT_EQ(Found(FilteredDepth{}).told(), 0);
}

std::shared_ptr<SurfacePoints> show(Morph& morph, double stamp, FilteredDepth depth,
                                    const Vector3d& camera = {0, 0, 0.5}) {
  depth.T_world_sensor.translation() = camera;
  auto points = std::make_shared<SurfacePoints>();
  const Pinhole pinhole = test::small_camera().pinhole;
  morph.look({depth, pinhole});
  morph.fill({depth, pinhole}, {stamp, stamp + 0.01, kFrame}, points);
  check(*points);
  return points;
}

/// The first point that is there with an edge at one end of its way.
double largest_share(const std::vector<EdgePlane>& edges) {
  double largest = 0;
  for (const EdgePlane& edge : edges) {
    largest = std::max(largest, std::abs(static_cast<double>(edge.share)));
  }
  return largest;
}

TEST(EdgesOfAStream, ComeAndGoWhileASnapshotLasts) {
  Morph morph{{}};
  ASSERT_TRUE(show(morph, 0, filtered(flat))->edges.points.empty());
  const auto comes = show(morph, kFrame, filtered(roof));
  ASSERT_GT(comes->edges.points.size(), 100u);
  EXPECT_EQ(largest_share(comes->edges.end), 1);
  const auto stays = show(morph, 2 * kFrame, filtered(roof, kNoise, 2));
  EXPECT_EQ(largest_share(stays->edges.start), 1);
  const auto goes = show(morph, 3 * kFrame, filtered(flat));
  EXPECT_EQ(largest_share(goes->edges.start), 1);
}

TEST(EdgesOfAStream, StayWhereTheyAreWhenTheOriginMoves) {
  Morph morph{{}};
  FilteredDepth depth = filtered(roof);
  (void)show(morph, 0, depth);
  depth.T_world_sensor.translation().x() += 20;
  const Vector3d camera(20, 0, 0.5);
  const auto points = show(morph, kFrame, depth, camera);
  // The line of the ridge is at x = 0 and x = 20, at height 0.
  int checked = 0;
  for (const EdgePlane& edge : points->edges.start) {
    const Vector3d normal = edge.normal.cast<double>();
    const double first = normal.dot(-points->origin) - static_cast<double>(edge.offset);
    const double second =
        normal.dot(Vector3d(20, 0, 0) - points->origin) - static_cast<double>(edge.offset);
    EXPECT_LT(std::min(std::abs(first), std::abs(second)), 1.5e-3);
    ++checked;
  }
  EXPECT_GT(checked, 200);
}

}  // namespace
}  // namespace palpate
