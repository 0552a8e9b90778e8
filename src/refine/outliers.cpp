// Finds isolated outliers: points around which the others form neither a surface nor a line.

#include "refine/outliers.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/lines.hpp"
#include "prepare/places.hpp"

namespace palpate {
namespace {

// A point this many typical spacings from its neighbours has to be on a surface or a line with
// them: beside a surface local_spacings() gives an outlier twice that surface's, less what it
// averages.
constexpr float kOutlierSpacings = 1.8f;  // measured (tests/refine/outliers_test.cpp)
constexpr std::size_t kNeighbors = 9;     // derived: a point of a grid and the eight around it
constexpr float kSlender = 1.f / 3;       // judgement: of a surface's width, and of a line's length
// The square of how far the neighbours' middle is, against theirs: 0.6 at a surface's corner, less
// where they lie around.
constexpr float kAround = 0.5f;  // judgement: no corner of a surface
// Points, more than half of kNeighbors, the point itself among them; judgement.
constexpr std::ptrdiff_t kMostOfNearest = 5;

/// How the nearest neighbours of a point lie.
struct Neighborhood {
  bool like_a_surface = false;  ///< on a surface or along a line
  float aside = 1;              ///< 0: all around the point; 1: all far away on one side
};

Neighborhood neighborhood(const CellGrid& grid, std::uint32_t i,
                          std::span<const CellGrid::Neighbor> nearest) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (const CellGrid::Neighbor& other : nearest) {
    const Eigen::Vector3f offset = grid.points()[other.index] - grid.points()[i];
    sum += offset / static_cast<float>(kNeighbors);
    squares += offset * offset.transpose() / static_cast<float>(kNeighbors);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(squares - sum * sum.transpose());
  const Eigen::Vector3f spread = solver.eigenvalues().cwiseMax(0);
  const float slender = kSlender * kSlender;
  return {spread[0] < slender * spread[1] || spread[1] < slender * spread[2],
          sum.squaredNorm() / squares.trace()};
}

}  // namespace

std::vector<std::uint8_t> find_outliers(const CellGrid& grid, std::span<const float> spacings,
                                        double typical) {
  const auto near = static_cast<float>(typical);
  std::vector<std::uint8_t> doubted(grid.size());
  const auto look = [&](std::size_t i, std::vector<CellGrid::Neighbor>& nearest) {
    nearest_distinct(grid, static_cast<std::uint32_t>(i), kNeighbors, nearest);
    if (nearest.size() < kNeighbors) return Neighborhood{};
    return neighborhood(grid, static_cast<std::uint32_t>(i), nearest);
  };
  const auto each = [&](const auto& decide) {
    detail::parallel_each_with<std::vector<CellGrid::Neighbor>>(grid.size(), 4096, decide);
  };
  each([&](std::size_t i, auto& nearest) {
    if (spacings[i] <= kOutlierSpacings * near) return;
    const Neighborhood around = look(i, nearest);
    const bool company = nearest.size() > 1 && nearest[1].squared_distance <= near * near;
    doubted[i] = !company && !around.like_a_surface ? 1 : 0;
  });
  // Where surfaces meet, the nearest points lie on no one surface, but most of them lie on one.
  std::vector<std::uint8_t> outliers(grid.size());
  each([&](std::size_t i, auto& nearest) {
    if (doubted[i] == 0) return;
    const Neighborhood around = look(i, nearest);
    const auto settled = std::ranges::count_if(
        nearest, [&](const CellGrid::Neighbor& other) { return doubted[other.index] == 0; });
    const bool edge = around.aside < kAround && settled >= kMostOfNearest;
    outliers[i] = edge ? 0 : 1;
  });
  return outliers;
}

void refine_outliers(Surfels& s) {
  const PrepareOptions& options = s.options;
  if (options.paper || !options.remove_speckle || !options.estimate_normals) return;
  Radii& radii = s.radii;
  radii.outliers = find_outliers(s.sampling.grid, s.sampling.spacings, s.sampling.spacing);
  if (options.radius) return;
  for (std::size_t i = 0; i < radii.outliers.size(); ++i) {
    if (radii.outliers[i] != 0) {
      // Outliers are not to reach what is sampled finely.
      radii.values[i] = kUsualMultiple * static_cast<float>(s.sampling.spacing);
    }
  }
}

void refine_outliers_off_segments(Surfels& s) {
  if (s.radii.outliers.empty()) return;
  const Sampling& sampling = s.sampling;
  Weights& weights = s.weights;
  const std::vector<std::uint32_t>& segment = s.segments.segment;
  std::vector<std::uint32_t> off;
  std::vector<Eigen::Vector3f> positions;
  for (std::uint32_t i = 0; i < segment.size(); ++i) {
    if (segment[i] != SurfacePoints::Segments::kNone || weights.values[i] <= 0) continue;
    off.push_back(i);
    positions.push_back(sampling.grid.points()[i]);
  }
  if (off.empty()) return;
  const CellGrid grid(positions);
  std::vector<float> spacings = local_spacings(grid);
  widen_to_lines(spacings_of_lines(grid), spacings);
  const std::vector<std::uint8_t> outliers = find_outliers(grid, spacings, sampling.spacing);
  const double typical_squared = sampling.spacing * sampling.spacing;
  std::vector<CellGrid::Neighbor> nearest;
  for (std::size_t k = 0; k < outliers.size(); ++k) {
    const std::uint32_t i = off[grid.order()[k]];
    if (outliers[k] == 0) continue;
    nearest_distinct(sampling.grid, i, 2, nearest);
    if (nearest.size() > 1 && nearest[1].squared_distance <= typical_squared) continue;
    weights.values[i] = 0;
    ++weights.outliers;
  }
}

}  // namespace palpate
