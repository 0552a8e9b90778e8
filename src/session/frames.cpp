// Makes of frames and prepared surfaces what is shown of them.
#include "session/frames.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::session {

void publish_surface(const Source& prepared, Source& source) {
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({prepared.points(), 1, 1});
  source.publish(std::move(snapshot));
}

PointCloud cloud_of(const DepthFrame& frame) {
  const auto& [width, height, p, distortion] = frame.camera;
  const bool fits =
      width > 0 && height > 0 &&
      frame.depth.size() / static_cast<std::size_t>(width) == static_cast<std::size_t>(height) &&
      frame.depth.size() % static_cast<std::size_t>(width) == 0;
  if (!fits) {
    throw Error(
        fmt::format("a frame of {} x {} pixels has {} depths", width, height, frame.depth.size()));
  }
  PointCloud cloud;
  cloud.viewpoint = Eigen::Vector3d::Zero();
  cloud.width = static_cast<std::size_t>(width);
  cloud.height = static_cast<std::size_t>(height);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double z = static_cast<double>(frame.depth[i]);
    if (z <= 0) continue;
    const double x = (static_cast<double>(i % cloud.width) - p.cx) * z / p.fx;
    const double y = (static_cast<double>(i / cloud.width) - p.cy) * z / p.fy;
    cloud.positions.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    cloud.pixels.push_back(static_cast<std::uint32_t>(i));
  }
  return cloud;
}

}  // namespace palpate::session
