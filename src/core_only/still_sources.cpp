// Defines what sources do in a core by itself: they hold still. Nothing is pushed into them, and no
// cloud is a depth frame or has an eye.
#include "scene/source_inside.hpp"

namespace palpate {

std::shared_ptr<Streaming> make_streaming(const SourceOptions& /*options*/) {
  return nullptr;
}

void forget_frames(Streaming* /*streaming*/) {}

bool set_as_frame(Source& /*source*/, const PointCloud& /*cloud*/) {
  return false;
}

std::optional<SurfaceEye> eye_of(const PointCloud& /*cloud*/, const PrepareOptions& /*options*/,
                                 const Eigen::Isometry3d& /*T_world_sensor*/) {
  return std::nullopt;
}

}  // namespace palpate
