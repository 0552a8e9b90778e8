#pragma once

#include <Eigen/Core>
#include <vector>

#include "palpate/device/exploration.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The surface near some position, for planning an exploration.
struct MapSample {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< on the points' mean plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< unit, or zero: nothing is near
};

/// The region of a surface that is explored, and as much again around it, which is only an
/// obstacle: points with normals, indexed. Coordinates are relative to the surface's origin.
class SurfaceMap {
 public:
  /// What lies within patch / 2 of the median point, or everything if that is smaller.
  SurfaceMap(const ExploredSurface& surface, double patch, double radius);

  [[nodiscard]] std::size_t size() const { return grid_.size(); }
  [[nodiscard]] const Eigen::Vector3d& center() const { return center_; }
  /// Of the region, along its longest axis, m.
  [[nodiscard]] double extent() const { return extent_; }
  [[nodiscard]] bool inside(const Eigen::Vector3d& x) const {
    return (x - center_).squaredNorm() <= reach_ * reach_;
  }
  [[nodiscard]] Eigen::Vector3d point(std::size_t i) const {
    return grid_.points()[i].cast<double>();
  }

  /// The weighted mean plane of the points within R of `x`, at `x`.
  [[nodiscard]] MapSample at(const Eigen::Vector3d& x) const;

  /// How far the nearest point is, m.
  [[nodiscard]] double distance(const Eigen::Vector3d& x) const;

 private:
  void choose(const ExploredSurface& surface, double patch);
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

}  // namespace palpate
