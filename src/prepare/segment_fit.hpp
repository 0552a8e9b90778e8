// One fit of a smooth segment to the points around a position.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The smooth segment that a position lies on, fitted to the points around it. Points of other
/// segments (the far face of a plate, a shelf behind a shelf) do not take part: where heights along
/// the normal fall into two groups with an empty gap between them, those of the position's own
/// group alone count.
struct SegmentFit {
  std::size_t points = 0;  ///< that the fit is of; 0, and nothing else is set: they fit no plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, sign arbitrary; zero: undefined
  bool others = false;                               ///< are there points of other segments around?
  double planarity = 0;                              ///< 0-1, as Normals::confidences
  double residual = 0;                               ///< rms distance from the plane, m
  double off = 0;  ///< of the position itself from the quadric; of too few points, the plane, m
  double quadric_residual = 0;  ///< rms off the quadric, m; of too few points, the plane's
  double footprint = 0;         ///< root of the area per point, m

  /// Is there a plane that leaves no more than curvature and noise do? Of a fit within `radius`;
  /// `noise`: of the points, m. A crease leaves more.
  [[nodiscard]] bool is_smooth(double radius, double noise) const;

  /// Is there a smooth segment of many points, and is the position on it?
  [[nodiscard]] bool is_segment(double radius, double noise) const;
};

inline constexpr double kPlanar = 0.5;  ///< planarity of a plane, at least; judgement

/// The residual up to which a plane is enough and no quadric is tried, and up to which a quadric is
/// enough and no other segments are looked for, m.
[[nodiscard]] double flat_residual(double radius, double noise);

/// Fits one position after another; keeps its memory in between.
class SegmentFitter {
 public:
  /// The points within `reach` of `center`, whose spacing is `spacing` (0: all are of one segment).
  /// Where a quadric leaves no more than `smooth`, no other segments are looked for. All in m.
  [[nodiscard]] SegmentFit fit(const CellGrid& grid, const Eigen::Vector3f& center, double reach,
                               double spacing, double smooth = 0);

  /// The same of the points `near`, which are within `reach`.
  [[nodiscard]] SegmentFit fit(const CellGrid& grid, const Eigen::Vector3f& center,
                               std::span<const std::uint32_t> near, double reach, double spacing,
                               double smooth);

  /// Variance of the means of the last fit's residuals over square tiles (side in m), as if of
  /// one, m^2: the residuals' own where they are independent, more where neighbours err together.
  [[nodiscard]] double tile_variance(double reach, double tile) const;

  /// Points of a quadric, which has six terms, at least; judgement.
  static constexpr std::size_t kEnough = 10;
  /// The window of an outlier far away may hold a whole scan: of more points, every n-th is looked
  /// at (judgement, for time).
  static constexpr std::size_t kMostPoints = 1 << 14;

 private:
  [[nodiscard]] bool keep_own_group(const Eigen::Vector3d& axis, double spacing);
  [[nodiscard]] Eigen::Vector3d axis_of_nearest(double spacing, const Eigen::Vector3d& fallback);
  [[nodiscard]] SegmentFit fit_offsets(double reach);
  void subtract_quadric(double reach, SegmentFit& fit);

  std::vector<std::uint32_t> near_;
  std::vector<Eigen::Vector3d> offsets_;  // from the centre, m; of the own group
  std::vector<Eigen::Vector3d> some_;
  std::vector<double> heights_;
  std::vector<Eigen::Vector3d> local_;        // along and above the plane, m
  Eigen::Matrix<double, 6, 1> quadric_ = {};  // of its height, over the reach, m
};

}  // namespace palpate
