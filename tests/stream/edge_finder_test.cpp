// Finds edges and creases of depth frames whose faces are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "palpate/depth/depth_filter.hpp"
#include "stream/block_surface.hpp"
#include "stream/morph.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::DepthOf;
using test::kFrame;

constexpr double kLean = 35 * std::numbers::pi / 180;  // of both faces
constexpr double kNoise = 0.5e-3;                      // m

DepthOf face_leaning(double tilt, double at = 0) {
  return test::plane_depth({at, 0, 0.5}, {std::sin(tilt), 0, -std::cos(tilt)});
}
/// Two faces that meet in the line x = 0 at z = 0.5 m.
double roof(double x, double y) {
  return std::max(face_leaning(kLean)(x, y), face_leaning(-kLean)(x, y));
}
double valley(double x, double y) {
  return std::min(face_leaning(kLean)(x, y), face_leaning(-kLean)(x, y));
}
/// The roof, cut off 3.5 mm to each side of the line, which is less than R.
double blunt(double x, double y) {
  return std::max(roof(x, y), 0.5 + 3.5e-3 * std::tan(kLean));
}
/// A ridge of 50 degrees, which flat points near its line follow.
double shallow(double x, double y) {
  return std::max(face_leaning(25 * std::numbers::pi / 180)(x, y),
                  face_leaning(-25 * std::numbers::pi / 180)(x, y));
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

  /// Calls visit(place, R, edge) for all blocks in the middle of the image with a fit.
  void each(const std::function<void(const Vector3d&, double, const SurfacePoints::EdgePlane&)>&
                visit) const {
    for (std::size_t b = 0; b < depth.size(); ++b) {
      const int row = static_cast<int>(b) / depth.columns;
      if (depth.states[b] != FilteredDepth::State::fitted || row < 10 || row >= depth.rows - 10)
        continue;
      const std::uint32_t number = finder.number(b);
      const SurfacePoints::EdgePlane edge =
          number == EdgeFinder::kNone ? SurfacePoints::EdgePlane() : finder.plane(number);
      visit(depth.positions[b].cast<double>(), surface.radius(b), edge);
    }
  }
  [[nodiscard]] int told() const {
    int count = 0;
    each([&](const Vector3d&, double, const SurfacePoints::EdgePlane& edge) {
      count += edge.share != 0 ? 1 : 0;
    });
    return count;
  }
};

class TwoFaces : public testing::TestWithParam<bool> {};

TEST_P(TwoFaces, AreToldToTheBlocksOfEachOther) {
  const bool convex = GetParam();
  const Found found(filtered(convex ? roof : valley));
  int near = 0;
  int told = 0;
  found.each([&](const Vector3d& place, double radius, const SurfacePoints::EdgePlane& edge) {
    const double x = place.x();
    if (std::abs(x) < 0.7 * radius * std::cos(kLean)) ++near;
    if (edge.share == 0) return;
    if (std::abs(x) < 0.7 * radius * std::cos(kLean)) ++told;
    EXPECT_EQ(edge.share, convex ? 1 : -1);
    EXPECT_LT(std::abs(x), radius) << "too far away to matter";
    if (std::abs(x) < 1.5e-3) return;  // which of the two faces a block on the line has
    // The other face's: (sin, 0, -cos) of its tilt, through (0, 0, 0.5).
    const double tilt = (x > 0) == convex ? -kLean : kLean;
    const Vector3d normal(std::sin(tilt), 0, -std::cos(tilt));
    EXPECT_GT(edge.normal.cast<double>().dot(normal), std::cos(0.05)) << x;
    EXPECT_NEAR(edge.height, normal.dot(place - Vector3d(0, 0, 0.5)), 0.6e-3) << x;
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

std::shared_ptr<SurfacePoints> show_frame(Morph& morph, double stamp, FilteredDepth depth,
                                          const Vector3d& camera = {0, 0, 0.5}) {
  depth.T_world_sensor.translation() = camera;
  auto points = std::make_shared<SurfacePoints>();
  const Pinhole pinhole = test::small_camera().pinhole;
  morph.look({depth, pinhole});
  morph.fill({depth, pinhole}, {stamp, stamp + 0.01, kFrame}, points);
  check(*points);
  return points;
}

/// Calls visit(edge at the start, at the end, i) for all points with an edge.
void each_edge(const SurfacePoints& points,
               const std::function<void(const SurfacePoints::EdgePlane&,
                                        const SurfacePoints::EdgePlane&, std::size_t)>& visit) {
  for (std::size_t i = 0; i < points.edges.of_point.size(); ++i) {
    const std::uint32_t edge = points.edges.of_point[i];
    if (edge == SurfacePoints::Edges::kNone) continue;
    visit(points.edges.start[edge], points.edges.end[edge], i);
  }
}

// The flat image turns into faces, which takes its points along, and back.
TEST(EdgesOfAStream, ComeAndGoByAndByOnPointsThatAreThere) {
  Morph morph{{}};
  ASSERT_TRUE(show_frame(morph, 0, filtered(flat))->edges.start.empty());
  int coming = 0;
  each_edge(
      *show_frame(morph, kFrame, filtered(shallow)),
      [&](const SurfacePoints::EdgePlane& start, const SurfacePoints::EdgePlane& end, std::size_t) {
        ++coming;
        EXPECT_TRUE(start.share == 0 || start.share == 1) << "nor a point that appears";
        EXPECT_EQ(end.share, start.share == 0 ? 0.25f : 1.0f);
      });
  EXPECT_GT(coming, 100);
  for (int k = 2; k < 20; ++k) (void)show_frame(morph, k * kFrame, filtered(shallow, kNoise, 2));
  int going = 0;
  each_edge(
      *show_frame(morph, 20 * kFrame, filtered(flat)),
      [&](const SurfacePoints::EdgePlane& start, const SurfacePoints::EdgePlane& end, std::size_t) {
        going += start.share > 0.9f && end.share == 0.75f * start.share ? 1 : 0;
        EXPECT_LE(end.share, start.share);
      });
  EXPECT_GT(going, 100);
}

TEST(EdgesOfAStream, AreSteadyWhereNoiseHardlyLetsThemBeFound) {
  Morph morph{{}};
  double change = 0;
  int count = 0;
  for (unsigned k = 0; k < 20; ++k) {
    const auto points = show_frame(morph, k * kFrame, filtered(shallow, 2e-3, k + 1));
    if (k < 5) continue;
    each_edge(*points, [&](const SurfacePoints::EdgePlane& start,
                           const SurfacePoints::EdgePlane& end, std::size_t i) {
      if (!points->presences.empty() && points->presences[i] == 0) return;
      change += std::abs(static_cast<double>(end.share - start.share));
      ++count;
    });
  }
  EXPECT_GT(count, 1000);
  EXPECT_LT(change, 0.2 * count);
}

TEST(EdgesOfAStream, StayWhereTheyAreWhenTheOriginMoves) {
  Morph morph{{}};
  FilteredDepth depth = filtered(roof);
  (void)show_frame(morph, 0, depth);
  const Vector3d camera(20, 0, 0.5);
  const auto points = show_frame(morph, kFrame, depth, camera);
  // The line of the ridge is at x = 0 and x = 20, at height 0.
  int checked = 0;
  each_edge(*points, [&](const SurfacePoints::EdgePlane& start, const SurfacePoints::EdgePlane&,
                         std::size_t i) {
    const Vector3d place = points->origin + points->grid.points()[i].cast<double>();
    const Vector3d ridge(place.x() > 10 ? 20 : 0, place.y(), 0);
    const double at_ridge = start.normal.cast<double>().dot(ridge - place);
    EXPECT_NEAR(at_ridge + static_cast<double>(start.height), 0, 1.5e-3);
    ++checked;
  });
  EXPECT_GT(checked, 200);
}

TEST(EdgesOfAStream, CreasesOfWhatNobodySeesGo) {
  Morph morph{{}};
  for (int k = 0; k < 3; ++k) (void)show_frame(morph, k * kFrame, filtered(valley));
  const auto points = show_frame(morph, 3 * kFrame, filtered([](double, double) { return 0.4; }));
  int hidden = 0;
  each_edge(*points, [&](const SurfacePoints::EdgePlane& start, const SurfacePoints::EdgePlane& end,
                         std::size_t) {
    hidden += start.share < 0 ? 1 : 0;
    EXPECT_EQ(end.share, 0);
  });
  EXPECT_GT(hidden, 100);
}

}  // namespace
}  // namespace palpate
