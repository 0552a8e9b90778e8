// Planes go on behind what hides them, and end where they are not seen again.
#include "stream/hidden_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "field/formulas.hpp"
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

constexpr double kWall = 0.5;         // m
constexpr double kBar = 0.45;         // m
constexpr double kHalf = 0.03;        // of the bar, for 1 m of depth
constexpr double kPlaneNoise = 5e-4;  // m

double wall_behind_bar(double, double y) {
  return std::abs(y) < kHalf ? kBar : kWall;
}

FilteredDepth filtered_frame(const DepthOf& depth_of, double noise = kPlaneNoise,
                             unsigned seed = 1) {
  DepthFilter filter({.memory = 1});
  return filter.filter(test::frame_of(test::small_camera(), 0, depth_of, noise, seed),
                       test::looking_down());
}

struct Measured {
  FilteredDepth depth;
  BlockSurface surface{Kernel::wyvill};

  explicit Measured(FilteredDepth given) : depth(std::move(given)) { surface.measure(depth); }

  [[nodiscard]] std::size_t hidden() const { return surface.hidden().blocks().size(); }

  /// The sum of weights at a place.
  [[nodiscard]] double weight(const Eigen::Vector3f& at) const {
    double sum = 0;
    const auto add = [&](const Eigen::Vector3f& point, float radius, float area) {
      const double q = (point - at).squaredNorm() / (radius * radius);
      if (q < 1) sum += static_cast<double>(area / (radius * radius)) * wyvill(q).w;
    };
    for (std::size_t b = 0; b < depth.size(); ++b) {
      if (surface.radius(b) > 0) add(depth.positions[b], surface.radius(b), surface.area(b));
    }
    for (const std::uint32_t block : surface.hidden().blocks()) {
      const HiddenPlanes::Point& point = surface.hidden().at(block);
      add(point.position, point.radius, point.area);
    }
    return sum;
  }
};

TEST(HiddenPlanes, AWallGoesOnBehindABar) {
  const Measured measured(filtered_frame(wall_behind_bar));
  // 22 of 120 rows of pixels are the bar's.
  EXPECT_GT(measured.hidden(), 9u * 70u);
  for (const std::uint32_t block : measured.surface.hidden().blocks()) {
    const HiddenPlanes::Point& point = measured.surface.hidden().at(block);
    EXPECT_NEAR(point.position.z(), kWall, 1e-3);
    EXPECT_LT(point.normal.z(), -0.998f);
    EXPECT_LT(std::abs(point.position.y()), (kHalf + 0.006) * kWall);
    EXPECT_GT(point.position.z(), measured.depth.positions[block].z() + point.radius);
  }
}

TEST(HiddenPlanes, TheSurfaceIsWholeAcrossTheJoin) {
  const Measured measured(filtered_frame(wall_behind_bar));
  for (double y = -0.03; y <= 0.03; y += 1e-3) {
    EXPECT_NEAR(measured.weight(Vector3d(0.01, y, kWall).cast<float>()), 1, 0.3) << y;
  }
}

TEST(HiddenPlanes, ASurfaceThatEndsDoesNotGoOn) {
  const auto edge = [](double x, double) { return x < 0 ? kBar : kWall; };
  const auto step = [](double, double y) {
    return std::abs(y) < kHalf ? kBar : y < 0 ? kWall : kWall + 0.02;
  };
  const auto turned = [](double x, double y) {
    const double other = test::plane_depth({0, 0, kWall}, Vector3d(0, 0.6, -0.8))(x, y);
    return std::abs(y) < kHalf ? kBar : y < 0 ? kWall : other;
  };
  const auto through = [](double, double y) {
    return std::abs(y) < kHalf ? kBar : std::abs(y) < 2 * kHalf ? kWall + 0.1 : kWall;
  };
  for (const DepthOf& depth_of : {DepthOf(edge), DepthOf(step), DepthOf(turned)}) {
    EXPECT_EQ(Measured(filtered_frame(depth_of)).hidden(), 0u);
  }
  // Only what lies behind goes on.
  const Measured deeper(filtered_frame(through));
  for (const std::uint32_t block : deeper.surface.hidden().blocks()) {
    EXPECT_NEAR(deeper.surface.hidden().at(block).position.z(), kWall + 0.1, 3e-3);
  }
}

TEST(HiddenPlanes, NothingGoesOnOverMoreThanItsReach) {
  const auto wide = [](double, double y) { return std::abs(y) < 0.11 ? kBar : kWall; };
  EXPECT_EQ(Measured(filtered_frame(wide)).hidden(), 0u);
}

TEST(HiddenPlanes, ToleratesAnyFrame) {
  for (const DepthOf& depth_of :
       {DepthOf([](double, double) { return 0.0; }),
        DepthOf([](double x, double y) { return std::fmod(1e3 * (x + y), 2.0); })}) {
    EXPECT_NO_THROW((void)Measured(filtered_frame(depth_of)).hidden());
  }
  EXPECT_EQ(Measured(FilteredDepth{}).hidden(), 0u);
}

class HiddenPlanesOfAStream : public testing::Test {
 protected:
  void show(const DepthOf& depth_of) {
    const FilteredDepth depth = filtered_frame(depth_of, kPlaneNoise, ++shown_);
    points_ = std::make_shared<SurfacePoints>();
    const double stamp = kFrame * shown_;
    morph_.look({depth, pinhole_});
    morph_.fill({depth, pinhole_}, {stamp, stamp + 0.01, kFrame}, points_);
    check(*points_);
  }

  /// Calls visit(presence at the start, at the end) for the points of the wall behind the bar.
  template <class Visit>
  int each_behind(const Visit& visit) const {
    int count = 0;
    for (std::size_t i = 0; i < points_->size(); ++i) {
      const Vector3d end = points_->origin + points_->end_positions[i].cast<double>();
      if (std::abs(end.z()) > 0.01 || std::abs(end.y()) > 0.8 * kHalf * kBar) continue;
      ++count;
      const bool fades = !points_->presences.empty();
      visit(fades ? points_->presences[i] : 1, fades ? points_->end_presences[i] : 1);
    }
    return count;
  }

  Morph morph_{{}};
  Pinhole pinhole_ = test::small_camera().pinhole;
  std::shared_ptr<SurfacePoints> points_;
  unsigned shown_ = 0;
};

TEST_F(HiddenPlanesOfAStream, AppearWithoutAStepAndAreReplacedByWhatIsSeen) {
  const auto empty = [](double, double y) { return std::abs(y) < kHalf ? 0.0 : kWall; };
  show(empty);  // a wide hole goes on behind nothing
  EXPECT_EQ(each_behind([](float, float) {}), 0);
  show(wall_behind_bar);
  const int count = each_behind([](float start, float end) {
    EXPECT_EQ(start, 0);
    EXPECT_NEAR(end, kFrame / 0.5, 1e-5);
  });
  EXPECT_GT(count, 400);
  for (int k = 0; k < 20; ++k) show(wall_behind_bar);
  float least = 1;
  each_behind([&](float, float end) { least = std::min(least, end); });
  EXPECT_GT(least, 0.9f);
  show(test::wall(kWall));
  const int seen = each_behind([&](float start, float) { EXPECT_GT(start, 0.9f); });
  EXPECT_GE(seen, count);
  EXPECT_LE(points_->size(), 80u * 60u + 2u * count) << "the bar fades";
}

TEST_F(HiddenPlanesOfAStream, FadeWhenTheyAreNotSeenToGoOn) {
  const auto ends = [](double, double y) { return y < kHalf ? kBar : kWall; };
  for (int k = 0; k < 3; ++k) show(wall_behind_bar);
  EXPECT_GT(each_behind([](float, float) {}), 400);
  for (int k = 0; k * kFrame < 1; ++k) {
    show(ends);
    each_behind([](float start, float end) { EXPECT_GT(end, start - 2.1f * kFrame); });
  }
  EXPECT_EQ(each_behind([](float, float) {}), 0);
}

TEST_F(HiddenPlanesOfAStream, WhatWasSeenThereIsRememberedInstead) {
  show(test::wall(kWall));
  const int count = each_behind([](float, float) {});
  for (int k = 0; k < 5; ++k) show(wall_behind_bar);
  EXPECT_LE(each_behind([](float, float) {}), count);
}

TEST_F(HiddenPlanesOfAStream, AreThereAtOnceInASingleFrame) {
  show(wall_behind_bar);
  EXPECT_GT(each_behind([](float, float end) { EXPECT_EQ(end, 1); }), 400);
}

}  // namespace
}  // namespace palpate
