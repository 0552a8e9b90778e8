// Clouds of lines: slices of a volume, the lines of a scanner.
#include "prepare/lines.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr float kGap = 0.01f;

/// `lines` lines a gap apart, their points `ratio` times as near each other and up to `noise` of
/// that off the lines, turned somewhere.
CellGrid lines_of(int lines, float ratio, float noise = 0) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> off(-0.2f, 0.2f);
  const Eigen::AngleAxisf turn(0.7f, Vector3f(1, 2, 3).normalized());
  std::vector<Vector3f> points;
  for (int i = 0; i < lines; ++i) {
    for (int j = 0; j < 25 * static_cast<int>(ratio); ++j) {
      const float along = (static_cast<float>(j) + off(random)) / ratio;
      const float beside = static_cast<float>(i) + 5 * noise * off(random) / ratio;
      points.emplace_back(turn * (kGap * Vector3f(along, beside, 5 * noise * off(random) / ratio)));
    }
  }
  return CellGrid(points);
}

std::vector<float> widened(const CellGrid& grid) {
  std::vector<float> spacings = local_spacings(grid);
  if (lies_in_lines(grid)) widen_to_lines(spacings_of_lines(grid), spacings);
  return spacings;
}

// A square grid's holes reach s / sqrt(2) from its points, those between lines half the way from
// one point to the opposite one.
TEST(Lines, HaveTheSpacingOfTheSquareGridWithTheSameHoles) {
  for (const float ratio : {5.f, 6.f, 10.f, 80.f}) {
    const std::vector<float> spacings = widened(lines_of(25, ratio));
    const float expected = kGap * std::sqrt((1 + 1 / (ratio * ratio)) / 2);
    EXPECT_NEAR(median(spacings), expected, 0.1 * expected) << ratio;
    EXPECT_LT(*std::ranges::max_element(spacings), 1.5f * expected) << ratio;
  }
}

// Rings near the lidar are as near one another as their points; far away they are not.
TEST(Lines, AreWidenedInACloudThatIsMostlyASurface) {
  const CellGrid lines = lines_of(25, 10);
  std::vector<Vector3f> points(lines.points().begin(), lines.points().end());
  const auto on_lines = points.size();
  std::mt19937 random(6);
  std::uniform_real_distribution<float> off(-0.3f, 0.3f);
  constexpr float kStep = kGap / 10;
  for (int i = 0; i < 140; ++i) {
    for (int j = 0; j < 140; ++j) {
      const Vector3f at(static_cast<float>(i) + off(random), static_cast<float>(j) + off(random),
                        0);
      points.emplace_back(Vector3f(100 * kGap, 0, 0) + kStep * at);
    }
  }
  const CellGrid grid(points);
  const std::vector<float> spacings = widened(grid);
  std::vector<float> of_lines;
  std::vector<float> of_surface;
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    (grid.order()[i] < on_lines ? of_lines : of_surface).push_back(spacings[i]);
  }
  EXPECT_NEAR(median(of_lines), kGap * std::sqrt(0.505f), 0.1 * kGap);
  EXPECT_NEAR(median(of_surface), kStep, 0.1 * kStep);
}

TEST(Lines, AreFoundThoughNoiseHidesThemAmongTheNearest) {
  for (const float ratio : {10.f, 20.f, 30.f}) {
    const float expected = kGap * std::sqrt((1 + 1 / (ratio * ratio)) / 2);
    EXPECT_NEAR(median(widened(lines_of(25, ratio, 0.8f))), expected, 0.1 * expected) << ratio;
  }
}

TEST(Lines, AtTheRimHaveTheSpacingOfTheNextLine) {
  const std::vector<float> spacings = widened(lines_of(25, 10));
  EXPECT_GT(*std::ranges::min_element(spacings), 0.6f * kGap);
}

TEST(Lines, AreNoGrids) {
  const CellGrid grid = lines_of(25, 1);
  EXPECT_EQ(widened(grid), local_spacings(grid));
}

TEST(Lines, ThatLieAloneStayAsTheyAre) {
  const CellGrid grid = lines_of(1, 10);
  EXPECT_EQ(widened(grid), local_spacings(grid));
}

}  // namespace
}  // namespace palpate
