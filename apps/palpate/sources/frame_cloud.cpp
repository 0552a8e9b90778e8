#include "apps/palpate/sources/frame_cloud.hpp"

namespace palpate::app {

PointCloud cloud_of(const DepthFrame& frame) {
  const Pinhole& p = frame.camera.pinhole;
  PointCloud cloud;
  cloud.viewpoint = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double z = static_cast<double>(frame.depth[i]);
    if (z <= 0) continue;
    const auto width = static_cast<std::size_t>(frame.camera.width);
    const double x = (static_cast<double>(i % width) - p.cx) * z / p.fx;
    const double y = (static_cast<double>(i / width) - p.cy) * z / p.fy;
    cloud.positions.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  }
  return cloud;
}

}  // namespace palpate::app
