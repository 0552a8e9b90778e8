// Decides whether a cloud was seen from one position.
#include "stream/one_view.hpp"

#include "palpate/depth/depth_frame.hpp"

namespace palpate {
namespace {

/// Did a camera at the cloud's viewpoint see each point in its pixel? That of a cloud which
/// somebody took to another frame did not.
bool is_view(const PointCloud& cloud) {
  if (!cloud.viewpoint) return false;
  const std::optional<DepthFrame> image = depth_frame_of(cloud).frame;
  if (!image) return false;
  const Eigen::Isometry3d stand = image->T_world_sensor.value_or(Eigen::Isometry3d::Identity());
  return stand.translation() == *cloud.viewpoint;
}

/// Do given normals face the cloud's viewpoint, all but a hundredth? Those of a closed body that
/// was seen from outside do not.
bool normals_face_viewpoint(const PointCloud& cloud) {
  constexpr double kOthers = 0.01;  // share; normals of mixed pixels are anything (judgement)
  if (!cloud.viewpoint || cloud.normals.size() != cloud.size() || cloud.empty()) return false;
  std::size_t others = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d to_eye = *cloud.viewpoint - cloud.point(i);
    if (!(cloud.normals[i].cast<double>().dot(to_eye) > 0)) ++others;
  }
  return static_cast<double>(others) <= kOthers * static_cast<double>(cloud.size());
}

/// Do normals get their signs from where the sensor is?
bool finds_sides(const PrepareOptions& options) {
  using Orientation = PrepareOptions::Orientation;
  return options.orientation == Orientation::automatic ||
         options.orientation == Orientation::viewpoint;
}

}  // namespace

std::optional<SurfaceEye> OneView::eye_of(const PointCloud& cloud, const PrepareOptions& options,
                                          const Eigen::Isometry3d& T_world_sensor) {
  if (!finds_sides(options)) return {};
  if (options.viewpoint) return SurfaceEye{T_world_sensor * *options.viewpoint, {}};
  const bool given = !cloud.normals.empty();
  if (!given) proved_ = proved_ || is_view(cloud);
  if (!(given ? normals_face_viewpoint(cloud) : proved_)) return {};
  const Eigen::Vector3d own = cloud.viewpoint.value_or(Eigen::Vector3d::Zero());
  return SurfaceEye{T_world_sensor * own, {}};
}

}  // namespace palpate
