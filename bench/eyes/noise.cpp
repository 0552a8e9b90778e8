// Draws the noise of cameras.
#include "eyes/view.hpp"

namespace palpate::eyes {
namespace {

void set_noise(const std::string& name, View& view, SimulatedCameraOptions& camera) {
  if (name != "waves") {
    SimulatedSetup setup{view.scene, camera};
    const std::uint64_t seed = camera.noise.seed;
    set_simulated(setup, "noise=" + name);
    camera.noise = setup.camera.noise;
    camera.noise.seed = seed;
    camera.noise.silhouettes = name != "tof";
    return;
  }
  SimulatedNoiseOptions& noise = camera.noise;
  noise.correlation = view.between(8, 18);
  noise.disparity_step = view.between(1 / 32.0, 1 / 5.0);
  noise.smoothing = static_cast<int>(view.between(0, 4));
  noise.pattern = view.between(0, 1e-3);
  noise.hops = view.one_of({0, 0, 0.01});
  camera.repeated = view.one_of({0, 0.3});
}

}  // namespace

void set_noise(const std::string& name, View& view) {
  for (SimulatedCameraOptions& camera : view.cameras) set_noise(name, view, camera);
}

}  // namespace palpate::eyes
