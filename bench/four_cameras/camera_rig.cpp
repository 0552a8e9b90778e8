// Sets up four simulated cameras whose frames are looped.
#include "four_cameras/camera_rig.hpp"

#include <fmt/format.h>

#include "palpate/base/error.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::four_cameras {

namespace {

constexpr int kLoop = 32;        // frames; judgement: about a second
constexpr double kRate = 30;     // Hz; judgement: the rate of most depth cameras
constexpr double kApart = 0.05;  // m from the middle of the four to each; judgement

SimulatedCameraOptions options_of(const SimulatedSetup& setup, int k, const Clock& clock) {
  SimulatedCameraOptions options = setup.camera;
  options.name = fmt::format("camera {}", k + 1);
  const Eigen::Vector3d aside((k & 1) == 0 ? kApart : -kApart, (k & 2) == 0 ? kApart : -kApart, 0);
  options.T_world_camera = options.T_world_camera * Eigen::Translation3d(aside);
  options.noise.seed = static_cast<std::uint64_t>(k + 1);
  options.rate = kRate;
  options.phase = k / (kRate * kCameras);
  options.loop = kLoop;
  options.clock = &clock;
  options.start.reset();
  return options;
}

}  // namespace

CameraRig::CameraRig(const Clock& clock) {
  const SimulatedSetup setup = make_simulated_setup("table");
  for (int k = 0; k < kCameras; ++k) {
    cameras_.push_back(std::make_unique<SimulatedCamera>(setup.scene, options_of(setup, k, clock)));
  }
}

void CameraRig::add_sources(Scene& scene) {
  for (int k = 0; k < kCameras; ++k) scene.add(fmt::format("camera {}", k + 1));
}

void CameraRig::show_once(Scene& scene) {
  DepthFrame frame;
  for (int k = 0; k < kCameras; ++k) {
    int tries = 0;
    while (camera(k).read(frame, 0.1) != DepthCamera::Status::frame) {
      if (++tries == 100) throw Error(fmt::format("camera {} gives no frame", k + 1));
    }
    scene.source(static_cast<std::size_t>(k)).push(frame, [] { return 0.0; });
    scene.source(static_cast<std::size_t>(k)).keep();
  }
}

}  // namespace palpate::four_cameras
