#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::rivals {

/// The points that are shown, and who is near a place. Places in it are those of the index.
class NearPoints {
 public:
  NearPoints() = default;
  explicit NearPoints(const PointCloud& cloud);

  [[nodiscard]] std::size_t size() const { return grid_.size(); }
  [[nodiscard]] Eigen::Vector3d at(std::uint32_t i) const {
    return grid_.points()[i].cast<double>();
  }
  /// All within `radius`; valid until the next question.
  [[nodiscard]] std::span<const std::uint32_t> within(const Eigen::Vector3d& center,
                                                      double radius) const;
  /// The nearest ones, nearest first; likewise.
  [[nodiscard]] std::span<const CellGrid::Neighbor> nearest(const Eigen::Vector3d& center,
                                                            std::size_t count) const;
  [[nodiscard]] std::uint32_t nearest(const Eigen::Vector3d& center) const {
    return nearest(center, 1)[0].index;
  }
  /// Where the outside is at a point: along its normal where it has one, else to the viewpoint,
  /// else up.
  [[nodiscard]] Eigen::Vector3d outside(std::uint32_t i) const;

 private:
  CellGrid grid_;
  std::vector<Eigen::Vector3f> normals_;  // in the index's order; may be empty
  Eigen::Vector3d viewpoint_;
  bool has_viewpoint_ = false;
  mutable std::vector<std::uint32_t> found_;
  mutable std::vector<CellGrid::Neighbor> neighbors_;
};

}  // namespace palpate::rivals
