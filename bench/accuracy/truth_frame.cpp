// Renders frames of a scene and makes points of them.
#include "accuracy/truth_frame.hpp"

#include "accuracy/truth_scene.hpp"
#include "sim/simulated_depth.hpp"

namespace palpate::accuracy {

DepthFrame exact_frame(const TruthScene& scene) {
  DepthFrame frame;
  frame.camera = scene.camera.model;
  DepthRenderer(frame.camera).render(scene.solids, scene.camera.T_world_camera, frame.depth);
  return frame;
}

DepthFrame noisy_frame(const DepthFrame& exact, const SimulatedNoiseOptions& noise) {
  DepthFrame frame = exact;
  SimulatedNoise(noise).apply(frame.camera.width, frame.camera.height, 0, frame.depth);
  return frame;
}

PointCloud back_project(const DepthFrame& frame) {
  PointCloud cloud;
  cloud.viewpoint = Eigen::Vector3d::Zero();
  cloud.positions.reserve(frame.depth.size());
  const Pinhole& pinhole = frame.camera.pinhole;
  std::size_t pixel = 0;
  for (int v = 0; v < frame.camera.height; ++v) {
    for (int u = 0; u < frame.camera.width; ++u) {
      const double z = frame.depth[pixel++];
      const Eigen::Vector3d ray((u - pinhole.cx) / pinhole.fx, (v - pinhole.cy) / pinhole.fy, 1);
      if (z > 0) cloud.positions.push_back((z * ray).cast<float>());
    }
  }
  return cloud;
}

}  // namespace palpate::accuracy
