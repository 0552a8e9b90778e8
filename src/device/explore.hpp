#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "palpate/device/simulated.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate {

/// The surface that is explored. World frame.
struct ExploredSurface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m; points are relative to it
  std::span<const Eigen::Vector3f> points;           ///< m
  std::span<const Eigen::Vector3f> normals;  ///< unit or zero; empty: fitted, away from the middle
};

/// The surface near some position, for planning an exploration.
struct MapSample {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the points' mean plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< unit, or zero: nothing is near
};

/// The region of a surface that is explored, and as much again around it, which is only an
/// obstacle: points with normals, indexed. Coordinates are relative to the surface's origin.
class SurfaceMap {
 public:
  /// What is explored reaches region / 2 from the median point; it is the whole surface if no side
  /// of its box is longer than `region`.
  SurfaceMap(const ExploredSurface& surface, double region, double radius);

  [[nodiscard]] std::size_t size() const { return grid_.size(); }
  [[nodiscard]] const Eigen::Vector3d& center() const { return center_; }
  /// Length of the region along its longest axis, m.
  [[nodiscard]] double extent() const { return extent_; }
  [[nodiscard]] bool inside(const Eigen::Vector3d& x) const {
    return (x - center_).squaredNorm() <= reach_ * reach_;
  }
  [[nodiscard]] Eigen::Vector3d point(std::size_t i) const {
    return grid_.points()[i].cast<double>();
  }

  /// The weighted mean plane of the points within R of `x`, at `x`.
  [[nodiscard]] MapSample at(const Eigen::Vector3d& x) const;

  /// Distance to the nearest point, m.
  [[nodiscard]] double distance(const Eigen::Vector3d& x) const;

 private:
  void choose(const ExploredSurface& surface, double region);
  [[nodiscard]] Eigen::Vector3f fitted_normal(std::size_t i) const;

  double radius_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double extent_ = 0;
  double reach_ = 0;
  CellGrid grid_;
  std::vector<Eigen::Vector3f> normals_;  // in the grid's order
  mutable std::vector<std::uint32_t> near_;
  mutable std::vector<CellGrid::Neighbor> nearest_;
};

/// Options of a hand that explores. Lengths and speeds are the world's.
struct StrokeOptions {
  double duration = 10;        ///< s
  double period = 1e-3;        ///< s between rows
  double radius = 0.01;        ///< R: the length in which the surface is smooth, m; > 0
  double depth = 5e-3;         ///< of the hand's target below the rendered surface while sliding, m
  double offset = 0;           ///< of the rendered surface above the points, m
  double region = 0.3;         ///< largest extent of the region that is explored, m; > 0
  double slide_speed = 0.1;    ///< m/s
  double travel_speed = 0.25;  ///< m/s, through free space
  std::vector<Ball> tool = {};  ///< a tool that turns, from its handle on, m; empty: a point
  std::uint64_t seed = 1;       ///< of the random choice of positions and directions
  std::function<void(double)> progress = {};  ///< called with the share done, 0 to 1
};

/// The target of a hand that explores a surface: it comes down along a normal, presses, slides,
/// lifts off, moves to another position through free space (above all obstacles, if there is such a
/// path), and so on until the time is over. Strokes begin where nothing was touched yet and follow
/// the points until they end or the stroke is long enough. Moves begin and end at rest. Clouds
/// larger than `region` are explored around their median point. Same input, same trajectory; no
/// clock and no thread.
/// `presses` (nullable) gets the times at which the hand slides, with the target's depth as pull
/// and the way above each stroke, which is free.
/// @throws Error when there are no points or an option is out of range.
[[nodiscard]] Trajectory explore(const ExploredSurface& surface, const StrokeOptions& options = {},
                                 std::vector<Press>* presses = nullptr);

/// 1 where a hand can explore `extent` metres as they are, else the fitting one of
/// ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ...
[[nodiscard]] double workspace_scale(double extent);

}  // namespace palpate
