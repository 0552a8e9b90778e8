#include "prepare/close_gaps.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "field/density_sums.hpp"

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

TEST(CloseGaps, RaisesWhatOthersLieRoundAbout) {
  Case made = make_case(Vector3f::Zero(), 0.5f * kGapSpacing);
  detail::WeightSums sums = weight_sums(made.grid, made.radii, Kernel::wyvill);
  EXPECT_EQ(sums.own[made.odd], 1);
  EXPECT_GT(close_gaps(made.grid, Kernel::wyvill, made.radii, sums), 200u);
  EXPECT_NEAR(made.radii[made.odd], 2.5f * kGapSpacing, 1e-6f);
  const detail::WeightSums again = weight_sums(made.grid, made.radii, Kernel::wyvill);
  for (std::size_t i = 0; i < again.own.size(); ++i) {
    EXPECT_NEAR(sums.own[i], again.own[i], 1e-4f);
  }
}

TEST(CloseGaps, LeavesStrayPointsAndWholeSheetsAlone) {
  for (const float height : {0.0f, 3 * kGapSpacing}) {
    Case made = make_case({0, 0, height}, 2.5f * kGapSpacing);
    const std::vector<float> before = made.radii;
    detail::WeightSums sums = weight_sums(made.grid, made.radii, Kernel::wyvill);
    EXPECT_EQ(close_gaps(made.grid, Kernel::wyvill, made.radii, sums), 0u) << height;
    EXPECT_EQ(made.radii, before);
  }
}

TEST(CloseGaps, TakesCloudsWithoutGaps) {
  std::vector<float> radii;
  detail::WeightSums sums;
  EXPECT_EQ(close_gaps(CellGrid(), Kernel::wyvill, radii, sums), 0u);
  const CellGrid pile(std::vector<Vector3f>(5, Vector3f::Ones()));
  radii.assign(5, 1e-3f);
  sums = weight_sums(pile, radii, Kernel::wendland);
  EXPECT_EQ(close_gaps(pile, Kernel::wendland, radii, sums), 0u);
}

}  // namespace
}  // namespace palpate
