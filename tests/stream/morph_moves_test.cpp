// Checks which points follow a surface that moves, and how far.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "palpate/depth/depth_filter.hpp"
#include "stream/morph.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using test::kFrame;

std::shared_ptr<SurfacePoints> show(
    Morph& morph, double stamp, const test::DepthOf& depth_of,
    const std::function<void(FilteredDepth&)>& change = [](FilteredDepth&) {}) {
  const DepthFrame frame = test::frame_of(test::small_camera(), stamp, depth_of);
  DepthFilter filter({.memory = 1});
  FilteredDepth depth = filter.filter(frame, test::looking_down());
  change(depth);
  auto points = std::make_shared<SurfacePoints>();
  morph.look({depth, frame.camera.pinhole});
  morph.fill({depth, frame.camera.pinhole}, {stamp, stamp + 0.01, kFrame}, points);
  check(*points);
  return points;
}

constexpr double kTilt = 35 * std::numbers::pi / 180;

test::DepthOf leaning(double z, double tilt) {
  return test::plane_depth({0, 0, z}, {std::sin(tilt), 0, -std::cos(tilt)});
}

// Up to 34 mm before one leaning plane, another leans the other way: near enough to have been it a
// frame ago, were it not for where it faces.
double before_another(double x, double y) {
  return std::abs(x) < 0.02 ? leaning(0.48, kTilt)(x, y) : leaning(0.5, -kTilt)(x, y);
}

TEST(MorphMoves, WhatFacesElsewhereHidesASurfaceAndDoesNotTakeItAlong) {
  Morph morph{{}};
  const std::size_t count = show(morph, 0, leaning(0.5, -kTilt))->size();
  const auto points = show(morph, kFrame, before_another);
  std::size_t still = 0;
  for (std::size_t i = 0; i < points->size(); ++i) {
    const Eigen::Vector3f way = points->end_positions[i] - points->grid.points()[i];
    EXPECT_LT(way.norm(), 5e-3);
    const bool stays = points->density_weights[i] > 0 && points->end_density_weights[i] > 0;
    if (stays && points->end_presences[i] > 0.99) ++still;
  }
  EXPECT_GT(points->size(), count + 100);
  EXPECT_EQ(still, count);
}

TEST(MorphMoves, WhatFliesAloneBetweenTwoSurfacesIsNotShown) {
  Morph morph{{}};
  const std::size_t count = show(morph, 0, test::wall(0.5))->size();
  const auto flying = [](double x, double y) { return std::hypot(x, y) < 0.004 ? 0.3 : 0.5; };
  const auto points = show(morph, kFrame, flying);
  EXPECT_EQ(points->size(), count);
  for (std::size_t i = 0; i < count; ++i) EXPECT_GT(points->density_weights[i], 0);
}

std::size_t middle_of(const FilteredDepth& depth) {
  return static_cast<std::size_t>(depth.rows / 2 * depth.columns + depth.columns / 2);
}

// One block in the middle is so far nearer, and no surer than that.
std::function<void(FilteredDepth&)> noisy(float nearer, float deviation) {
  return [=](FilteredDepth& depth) {
    const std::size_t middle = middle_of(depth);
    depth.positions[middle] *= 1 - nearer / depth.positions[middle].z();
    depth.deviations[middle] = deviation;
  };
}

TEST(MorphMoves, WhatNoiseExplainsTakesNoPointFartherThanItReaches) {
  Morph morph{{}};
  const std::size_t count = show(morph, 0, test::wall(0.5))->size();
  const auto points = show(morph, kFrame, test::wall(0.5), noisy(0.06f, 0.012f));
  EXPECT_EQ(points->size(), count);
  for (std::size_t i = 0; i < points->size(); ++i) {
    const Eigen::Vector3f way = points->end_positions[i] - points->grid.points()[i];
    EXPECT_LT(way.norm(), 2e-3);
    EXPECT_GT(points->end_density_weights[i], 0);
  }
}

// How far along its normal the surface goes that was known to 0.1 mm, when all blocks are 1 mm
// nearer and no surer than `deviation`.
float followed(float deviation) {
  Morph morph{{}};
  const auto all = [](float nearer, float sure) {
    return [=](FilteredDepth& depth) {
      for (Eigen::Vector3f& position : depth.positions) position *= 1 - nearer / position.z();
      std::fill(depth.deviations.begin(), depth.deviations.end(), sure);
    };
  };
  show(morph, 0, test::wall(0.5), all(0, 1e-4f));
  const auto points = show(morph, kFrame, test::wall(0.5), all(1e-3f, deviation));
  float most = 0;
  for (std::size_t i = 0; i < points->size(); ++i) {
    const Eigen::Vector3f way = points->end_positions[i] - points->grid.points()[i];
    most = std::max(most, std::abs(way.dot(points->normals[i])));
  }
  return most;
}

TEST(MorphMoves, BlocksThatAreMuchLessSureThanWhatIsKnownCountForAsMuchLess) {
  EXPECT_NEAR(followed(1e-4f), 1e-3, 3e-4);
  EXPECT_NEAR(followed(1.9e-4f), 1e-3, 3e-4);
  EXPECT_LT(followed(1e-3f), 0.1e-3);
}

TEST(MorphMoves, ABlockThatTurnsAwayWithinAFrameIsNotBelieved) {
  Morph morph{{}};
  show(morph, 0, test::wall(0.5));
  const auto turned = [](FilteredDepth& depth) {
    const std::size_t middle = middle_of(depth);
    depth.positions[middle] *= 1.004f;
    depth.normals[middle] = Eigen::Vector3f::UnitX();
  };
  const auto points = show(morph, kFrame, test::wall(0.5), turned);
  EXPECT_GT(points->size(), 4500u);
  for (std::size_t i = 0; i < points->size(); ++i) {
    const Eigen::Vector3f way = points->end_positions[i] - points->grid.points()[i];
    EXPECT_LT(way.norm(), 1e-3);
    EXPECT_GT(points->end_normals[i].dot(points->normals[i]), 0.9);
  }
}

// Everything turns, or its normal was not known before: how many points are where, and face as, the
// wall is told after half a second.
std::size_t followed_turn(const Eigen::Vector3f& before) {
  Morph morph{{}};
  std::shared_ptr<SurfacePoints> points;
  for (int k = 0; k <= 15; ++k) {
    points = show(morph, k * kFrame, test::wall(0.5), [&](FilteredDepth& depth) {
      if (k > 0) return;
      for (Eigen::Vector3f& normal : depth.normals) normal = before;
    });
  }
  std::size_t good = 0;
  for (std::size_t i = 0; i < points->size(); ++i) {
    good += points->end_normals[i].z() > 0.9f && points->end_presences[i] > 0.99f ? 1 : 0;
  }
  return good;
}

TEST(MorphMoves, ATurnThatLastsIsFollowedWithoutAGap) {
  Morph morph{{}};
  const std::size_t count = show(morph, 0, test::wall(0.5))->size();
  EXPECT_EQ(followed_turn(Eigen::Vector3f::UnitX()), count);
  EXPECT_EQ(followed_turn(Eigen::Vector3f::Zero()), count);
}

TEST(MorphMoves, APointCountsByItsPrecisionBesideThoseAround) {
  constexpr float kNearer = 0.003f;
  Morph morph{{}};
  show(morph, 0, test::wall(0.5), noisy(kNearer, 0.01f));
  const auto points = show(morph, kFrame, test::wall(0.5), noisy(kNearer, 0.01f));
  const float wall = points->end_positions[0].z();
  int found = 0;
  for (std::size_t i = 0; i < points->size(); ++i) {
    const bool off = std::abs(points->end_positions[i].z() - wall) > kNearer / 2;
    found += off ? 1 : 0;
    if (off) {
      EXPECT_LT(points->end_density_weights[i], 0.05f);
    }
  }
  EXPECT_EQ(found, 1);
}

TEST(MorphMoves, AJumpThatNoHandMakesDoesNotMoveTheSurface) {
  Morph morph{{}};
  const std::size_t count = show(morph, 0, test::wall(0.5))->size();
  const auto points = show(morph, kFrame, test::wall(0.5 - 1.1 * kFrame));
  EXPECT_EQ(points->size(), 2 * count);
  for (std::size_t i = 0; i < points->size(); i += 7) {
    EXPECT_EQ(points->grid.points()[i], points->end_positions[i]);
  }
}

// Nine millimetres wide, near and far in turn: what comes before them hides both.
double strips(double x, double) {
  return std::fmod(x + 1, 0.04) < 0.02 ? 0.5 : 0.9;
}

TEST(MorphMoves, CellsOfWhatIsHiddenAreNotAsDeepAsTheScene) {
  Morph morph{{}};
  const std::size_t count = show(morph, 0, strips)->size();
  const auto points = show(morph, kFrame, test::wall(0.3));
  EXPECT_GT(points->size(), 3 * count / 2);
  std::size_t leaves = 0;
  for (const CellGrid::Cell& cell : points->grid.cells()) {
    if (cell.children > 0) continue;
    ++leaves;
    EXPECT_LT(cell.upper.z() - cell.lower.z(), 0.2f);
  }
  EXPECT_GT(leaves, points->size() / 16);
}

}  // namespace
}  // namespace palpate
