#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"
#include "scene/policies/moment.hpp"

namespace palpate {

/// The policy for clouds of a scene that stands still: a running mean in each voxel, over about
/// eight clouds, whose points go in straight lines from one mean to the next (algorithm.md section
/// 5.2). A voxel that no cloud fills any more fades away.
class Fusion {
 public:
  explicit Fusion(const PrepareOptions& prepare) : prepare_(prepare) {}

  /// The surface after one more cloud, which is in the sensor's frame.
  /// @throws Error as prepare() does.
  [[nodiscard]] SurfacePoints add(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor,
                                  const Moment& moment, PrepareReport& report);

  void forget() { voxels_.clear(); }

 private:
  using Key = std::array<std::int32_t, 3>;

  /// Means are relative to origin_.
  struct Voxel {
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d end = Eigen::Vector3d::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    double weight_start = 0;
    double weight_end = 0;
    int clouds = 0;
  };

  void age(const Moment& moment);
  void choose_leaf(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor);
  void mix(const PointCloud& cloud, const Eigen::Isometry3d& T_world_sensor);
  [[nodiscard]] PointCloud means() const;
  [[nodiscard]] SurfacePoints place(const Prepared& prepared);

  PrepareOptions prepare_;
  double leaf_ = 0;  // m; 0: no cloud yet
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Moment last_;
  std::map<Key, Voxel> voxels_;  // in a fixed order
};

}  // namespace palpate
