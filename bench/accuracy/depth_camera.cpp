#include "accuracy/depth_camera.hpp"

#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest = 5;      // m
constexpr double kTolerance = 1e-7;  // m

Vector3d pixel_ray(const Pinhole& pinhole, int u, int v) {
  return {(u - pinhole.cx) / pinhole.fx, (v - pinhole.cy) / pinhole.fy, 1};
}

// Sphere tracing: the distance to the nearest solid is a step that cannot cross a surface. Returns
// the way along the unit vector `direction`, or 0.
double trace(const TruthScene& scene, const Vector3d& eye, const Vector3d& direction) {
  double way = 0;
  while (way < kFarthest) {
    const double step = distance_and_normal(scene, eye + way * direction).value;
    if (step < kTolerance) return way;
    way += step;
  }
  return 0;
}

}  // namespace

DepthImage render_depth(const TruthScene& scene) {
  const DepthCamera& camera = scene.camera;
  DepthImage image{camera.width, camera.height, {}};
  image.depth.resize(static_cast<std::size_t>(camera.width) * camera.height);
  const Vector3d eye = camera.T_world_camera.translation();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d ray = pixel_ray(camera.pinhole, u, v);
      const Vector3d direction = camera.T_world_camera.linear() * ray.normalized();
      image.at(u, v) = trace(scene, eye, direction) / ray.norm();
    }
  }
  return image;
}

PointCloud back_project(const DepthImage& image, const Pinhole& pinhole) {
  PointCloud cloud;
  cloud.viewpoint = Vector3d::Zero();
  cloud.positions.reserve(image.depth.size());
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double z = image.at(u, v);
      if (z > 0) cloud.positions.push_back((z * pixel_ray(pinhole, u, v)).cast<float>());
    }
  }
  return cloud;
}

}  // namespace palpate::accuracy
