// Indexes the points that are shown.
#include "rivals/near_points.hpp"

namespace palpate::rivals {
namespace {

constexpr std::size_t kRoom = 1 << 14;  // points of one question; judgement: a step allocates none

}  // namespace

NearPoints::NearPoints(const PointCloud& cloud) : has_viewpoint_(cloud.viewpoint.has_value()) {
  std::vector<Eigen::Vector3f> positions(cloud.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = cloud.point(i).cast<float>();
  grid_ = CellGrid(positions);
  if (has_viewpoint_) viewpoint_ = *cloud.viewpoint;
  if (!cloud.normals.empty()) {
    for (const std::uint32_t i : grid_.order()) normals_.push_back(cloud.normals[i]);
  }
  found_.reserve(kRoom);
  neighbors_.reserve(kRoom);
}

std::span<const std::uint32_t> NearPoints::within(const Eigen::Vector3d& center,
                                                  double radius) const {
  found_.clear();
  grid_.within(center.cast<float>(), static_cast<float>(radius), found_);
  return found_;
}

std::span<const CellGrid::Neighbor> NearPoints::nearest(const Eigen::Vector3d& center,
                                                        std::size_t count) const {
  grid_.nearest(center.cast<float>(), count, neighbors_);
  return neighbors_;
}

Eigen::Vector3d NearPoints::outside(std::uint32_t i) const {
  if (!normals_.empty()) return normals_[i].cast<double>();
  if (has_viewpoint_) return (viewpoint_ - at(i)).normalized();
  return Eigen::Vector3d::UnitZ();
}

}  // namespace palpate::rivals
