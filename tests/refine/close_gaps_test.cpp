// Which points reach across the gap around them.

#include <gtest/gtest.h>

#include <algorithm>

#include "prepare/plane_fits.hpp"
#include "refine/gaps.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr int kHalf = 8;
constexpr float kGapSpacing = 0.01f;

/// A square grid whose middle is elsewhere, at `odd`.
struct Case {
  CellGrid grid;
  std::vector<float> radii;
  std::uint32_t odd = 0;
};

Case make_case(const Vector3f& odd, float radius) {
  std::vector<Vector3f> points = {odd};
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      if (i == 0 && j == 0) continue;
      points.emplace_back(kGapSpacing * static_cast<float>(i), kGapSpacing * static_cast<float>(j),
                          0.0f);
    }
  }
  Case made{CellGrid(points), {}, 0};
  made.radii.assign(points.size(), radius);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (made.grid.order()[i] == 0) made.odd = i;
  }
  return made;
}

/// How many radii were raised.
std::size_t close(Case& made, PointFits& own) {
  std::vector<float> spacings(made.grid.size(), kGapSpacing);
  const std::vector<float> noise(made.grid.size(), 0.f);
  const detail::NeighborhoodGraph graph = neighborhood_graph(made.grid, made.radii);
  own = fit_points(graph, spacings, made.radii, noise);
  const WeightSums sums(graph, made.radii);
  return close_gaps(graph, sums.own, noise, spacings, made.radii, own);
}

TEST(CloseGaps, RaisesWhatOthersLieRoundAbout) {
  Case made = make_case(Vector3f::Zero(), 0.5f * kGapSpacing);
  PointFits own;
  EXPECT_GT(close(made, own), 200u);
  EXPECT_NEAR(made.radii[made.odd], 2.5f * kGapSpacing, 1e-6f);
  EXPECT_GT(std::abs(own.normals[made.odd].z()), 0.999f);
  EXPECT_GT(own.confidences[made.odd], 0.9f);
}

TEST(CloseGaps, LeavesOutliersAndWholeSheetsAlone) {
  for (const float height : {0.0f, 3 * kGapSpacing}) {
    Case made = make_case({0, 0, height}, 2.5f * kGapSpacing);
    const std::vector<float> before = made.radii;
    PointFits own;
    EXPECT_EQ(close(made, own), 0u) << height;
    EXPECT_EQ(made.radii, before);
  }
}

/// A square grid of side 1 mm without the points less than `hole` (m) from the middle of a cell.
Case grid_around(float hole) {
  constexpr float kSide = 1e-3f;
  std::vector<Vector3f> points;
  for (int i = -12; i <= 12; ++i) {
    for (int j = -12; j <= 12; ++j) {
      const Vector3f place((static_cast<float>(i) + 0.5f) * kSide,
                           (static_cast<float>(j) + 0.5f) * kSide, 0);
      if (place.norm() >= hole) points.push_back(place);
    }
  }
  Case made{CellGrid(points), {}, 0};
  made.radii.assign(points.size(), 2.5f * kSide);
  return made;
}

TEST(CloseGaps, BridgesHolesOfTwoByTwoPoints) {
  Case made = grid_around(1e-3f);
  PointFits own;
  EXPECT_EQ(close(made, own), 8u);
  for (std::uint32_t i = 0; i < made.grid.size(); ++i) {
    const bool on_rim = made.grid.points()[i].norm() < 1.6e-3f;
    EXPECT_NEAR(made.radii[i], on_rim ? 5.59e-3f : 2.5e-3f, 1e-5f);  // 2.5 sqrt(2) sqrt(2.5) mm
  }
}

TEST(CloseGaps, LeavesHolesWiderThanASupport) {
  Case made = grid_around(3.2e-3f);
  PointFits own;
  EXPECT_EQ(close(made, own), 0u);
}

TEST(CloseGaps, TakesCloudsWithoutGaps) {
  PointFits own;
  Case pile{CellGrid(std::vector<Vector3f>(5, Vector3f::Ones())), std::vector<float>(5, 1e-3f)};
  EXPECT_EQ(close(pile, own), 0u);
  Case none;
  EXPECT_EQ(close(none, own), 0u);
}

}  // namespace
}  // namespace palpate
